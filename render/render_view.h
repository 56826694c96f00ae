#pragma once

#include "ecs/base/math.h"
#include "ecs/components/camera.h"
#include "ecs/components/transform.h"
#include "ecs/entity.h"
#include "render/thin_lens.h"

#include <optional>
#include <string_view>

namespace limn {

class World;

// From where, and between which two moments, a picture is taken.
//
// The simulation steps at a fixed rate and pictures fall between steps. A picture shows the moment
// `alpha` of the way from the step before (PreviousWorldTransform) to the last one
// (WorldTransform), and its motion vectors point back to `alpha_before`, the moment of the picture
// before, in the same measure: -0.1 if that picture lay a tenth of a step before the previous step.
// Headless pictures show the last step and its whole motion: 1 and 0.
//
// Depth is reversed with an infinite far plane: 1 at the near plane, near / distance beyond it.

struct RenderView {
    int width = 1;                   ///< of the picture [px], > 0
    int height = 1;                  ///< [px], > 0
    float near = 0.05f;              ///< [m], > 0
    Affine world_from_camera;        ///< unit scale; looks along -z
    Mat4 clip_from_world{1.0f};      ///< with the jitter
    Mat4 steady_from_world{1.0f};    ///< clip_from_world without the jitter
    Mat4 previous_from_world{1.0f};  ///< steady_from_world of the moment before
    Vec2 tangent = {1, 1};           ///< of half the field of view, along x and y
    Vec2 jitter = {0, 0};            ///< by which the picture is moved right and up [px]
    float alpha = 1.0f;              ///< moment shown, 0 .. 1
    float alpha_before = 0.0f;       ///< moment motion is measured from, <= alpha
    LensView lens;                   ///< what is in front of the camera; at first a pinhole
    Vec4 clip_plane = {0, 0, 0, 0};  ///< shown is where dot(xyz, p) + w >= 0; 0: everywhere
    Entity hidden;                   ///< not shown, nor what is below it; null: all is shown
};

/// What make_render_view needs beside the camera.
struct ViewRequest {
    int width = 1280;           ///< [px]
    int height = 720;           ///< [px]
    Vec2 jitter = {0, 0};       ///< [px]
    float alpha = 1.0f;         ///< see RenderView
    float alpha_before = 0.0f;  ///< see RenderView
};

/// Whether a camera jumped between two pictures: it turned by more than 60 degrees or moved by more
/// than 10 m (by eye: no camera that films does).
[[nodiscard]] bool is_cut(const Affine& before, const Affine& now);

/// From a camera that stands at `world_from_camera` (scale is dropped) and was at `previous`, from
/// where, after a cut, there is no motion.
[[nodiscard]] RenderView make_render_view(
    const Camera& camera, const Affine& world_from_camera, const Affine& previous,
    const ViewRequest& request = {});

/// The same view with its picture moved by `jitter` [px] instead.
[[nodiscard]] RenderView with_jitter(const RenderView& view, const Vec2& jitter);

/// The same view through one point of its lens instead of all, a pinhole again: the eye stands on
/// the aperture at radius * `point` (see point_on_aperture), and what is at the distance of focus
/// stays where it was in the picture. The mean over the aperture is what the lens shows. Jitter
/// goes first: with_lens_sample(with_jitter(view, jitter), point).
[[nodiscard]] RenderView with_lens_sample(const RenderView& view, const Vec2& point);

/// Tangents that hold all of the picture, however far a jitter of more than half a pixel moved it.
[[nodiscard]] Vec2 widest_tangent(const RenderView& view);

/// What a Lens beside a Camera asks for. Without one it is a pinhole; a lens that is none, too,
/// which is told of once.
[[nodiscard]] LensView lens_view(const World& world, Entity camera);

/// From an entity with Camera and WorldTransform, and through the Lens beside them.
[[nodiscard]] RenderView
make_render_view(const World& world, Entity camera, const ViewRequest& request = {});

/// The camera called `name`, or the first active one if `name` is empty, in world order.
[[nodiscard]] std::optional<Entity> find_camera(const World& world, std::string_view name = {});

/// Points from `eye` at `target`; +y up, or any other direction if that is straight up or down.
[[nodiscard]] Affine look_at(const Vec3& eye, const Vec3& target);

/// Where sample `index` of `count` of an accumulated picture lies in its pixel, -0.5 .. 0.5: the
/// R2 sequence (Roberts 2018). One sample alone lies in the middle.
[[nodiscard]] Vec2 sample_jitter(int index, int count);

/// The moment `alpha` of the way from `previous` to `current`, componentwise: exact for
/// translation, a chord of the arc for rotation.
[[nodiscard]] Affine mix_affine(const Affine& previous, const Affine& current, float alpha);

}  // namespace limn
