#pragma once

#include "ecs/base/math.h"
#include "ecs/components/camera.h"
#include "ecs/components/step_jumps.h"
#include "ecs/components/transform.h"
#include "ecs/entity.h"
#include "render/lens/thin_lens.h"

#include <optional>
#include <string_view>

namespace limn {

class World;

// The viewpoint of a frame, and the interval of time it covers.
//
// The simulation steps at a fixed rate and frames fall between steps. A frame shows the state at
// `alpha`, interpolated from the previous step (0, PreviousWorldTransform) to the last one (1,
// WorldTransform); its motion vectors point back to `previous_alpha`, the time of the previous
// frame in the same unit: -0.1 if that frame lay a tenth of a step before the previous step.
// Headless renders show the last step and its whole motion: 1 and 0.
//
// What jumped within the last step (StepJumps) is shown on one side or the other, by the time of
// the jump, and moves neither in this frame nor from the previous one.
//
// An orthographic camera is a perspective view from kOrthoDistance image heights farther back, with
// as narrow a field of view: depth, clusters, shadows and motion vectors need no second kind of
// projection, and what is one image height farther away is smaller by 1 / kOrthoDistance, a fifth
// of a pixel of 400. Fog begins at the camera itself.
//
// Depth is reversed with an infinite far plane: 1 at the near plane, near / distance beyond it.

inline constexpr float kOrthoDistance = 2048;

struct RenderView {
    int width = 1;                        ///< of the image [px], > 0
    int height = 1;                       ///< [px], > 0
    float near = 0.05f;                   ///< [m], > 0
    float pullback = 0;                   ///< of the eye, behind an orthographic camera [m]
    Affine world_from_camera;             ///< unit scale; looks along -z
    Mat4 clip_from_world{1.0f};           ///< with jitter
    Mat4 unjittered_from_world{1.0f};     ///< clip_from_world without jitter
    Mat4 previous_clip_from_world{1.0f};  ///< unjittered_from_world of the previous frame
    Vec2 tangent = {1, 1};                ///< tan(fov / 2) along x and y
    Vec2 jitter = {0, 0};                 ///< subpixel shift of the image, right and up [px]
    float alpha = 1.0f;                   ///< time shown, 0 .. 1
    float previous_alpha = 0.0f;          ///< time motion is measured from, <= alpha
    bool cut = false;                     ///< the camera jumped since the previous frame
    LensView lens;                        ///< a pinhole by default
    Entity entity;                        ///< of the camera; null: none
    Vec4 clip_plane = {0, 0, 0, 0};       ///< clips where dot(xyz, p) + w < 0; 0: no clipping
    Entity hidden;                        ///< hidden with its descendants; null: nothing is hidden
};

/// A time within the last step at which something is evaluated for a frame.
struct StepTime {
    float alpha = 1.0f;  ///< RenderView::alpha, or previous_alpha
    float shown = 1.0f;  ///< RenderView::alpha: decides which side of a jump is shown

    [[nodiscard]] bool is_before(float jump) const { return shown < jump; }
};

/// Arguments of make_render_view besides the camera.
struct ViewRequest {
    int width = 1280;             ///< [px]
    int height = 720;             ///< [px]
    Vec2 jitter = {0, 0};         ///< [px]
    float alpha = 1.0f;           ///< see RenderView
    float previous_alpha = 0.0f;  ///< see RenderView
};

/// Whether the camera jumped between two frames: rotated by more than 60 degrees or moved by more
/// than 10 m (by eye; no filming camera does).
[[nodiscard]] bool is_cut(const Affine& before, const Affine& now);

/// View of a camera at `world_from_camera` (scale is dropped) that was at `previous`; after a cut
/// there is no motion.
[[nodiscard]] RenderView make_render_view(
    const Camera& camera, const Affine& world_from_camera, const Affine& previous,
    const ViewRequest& request = {});

/// The same view with another `jitter` [px].
[[nodiscard]] RenderView with_jitter(const RenderView& view, const Vec2& jitter);

/// The same view through a single point of its lens, as a pinhole: the eye moves on the aperture to
/// radius * `point` (see point_on_aperture), and points at the focus distance stay where they were
/// in the image. The mean over the aperture is what the lens shows. Apply jitter first:
/// with_lens_sample(with_jitter(view, jitter), point).
[[nodiscard]] RenderView with_lens_sample(const RenderView& view, const Vec2& point);

/// `tangent`, widened to contain the whole image even after a jitter of more than half a pixel.
[[nodiscard]] Vec2 widest_tangent(const RenderView& view);

/// The lens of a Camera's entity. A pinhole without a Lens, or with an invalid one, which is logged
/// once.
[[nodiscard]] LensView lens_view(const World& world, Entity camera);

/// View of an entity with Camera, WorldTransform and optionally Lens.
[[nodiscard]] RenderView
make_render_view(const World& world, Entity camera, const ViewRequest& request = {});

/// The camera called `name`, or the first active one if `name` is empty, in world order.
[[nodiscard]] std::optional<Entity> find_camera(const World& world, std::string_view name = {});

/// Pose at `eye` facing `target`; +y is up unless the view direction is vertical.
[[nodiscard]] Affine look_at(const Vec3& eye, const Vec3& target);

/// Pixel offset of sample `index` of `count` of an accumulated image, -0.5 .. 0.5: the R2 sequence
/// (Roberts 2018). A single sample is at the center.
[[nodiscard]] Vec2 sample_jitter(int index, int count);

/// Interpolates from `previous` to `current` componentwise: exact for translation, a chord of the
/// arc for rotation.
[[nodiscard]] Affine mix_affine(const Affine& previous, const Affine& current, float alpha);

/// world_from_local of `entity` at `time`. `previous`: null for what never moves.
[[nodiscard]] Affine world_at(
    const StepJumps* jumps, Entity entity, const WorldTransform& now,
    const PreviousWorldTransform* previous, const StepTime& time);

}  // namespace limn
