#include "render/render_view.h"

#include "ecs/base/log.h"
#include "ecs/components/framing.h"
#include "ecs/components/name.h"
#include "ecs/world.h"

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <atomic>

// Techniques: post.distributed-sampling

namespace limn {
namespace {

constexpr float kMinCosine = 0.5f;  // of 60 degrees
constexpr float kMaxMove = 10.0f;   // [m]

Vec3 column(const Affine& a, int c) {
    return {a.row[0][c], a.row[1][c], a.row[2][c]};
}

/// Rotation and position only, without scale and shear.
Affine without_scale(const Affine& a) {
    const Vec3 back = normalize_or({a.row[0].z, a.row[1].z, a.row[2].z}, {0, 0, 1});
    const Vec3 up = {a.row[0].y, a.row[1].y, a.row[2].y};
    const Vec3 right = normalize_or(glm::cross(up, back), any_perpendicular(back));
    const Vec3 true_up = glm::cross(back, right);
    Affine rigid;
    for (int i = 0; i < 3; ++i) {
        rigid.row[i] = {right[i], true_up[i], back[i], a.row[i].w};
    }
    return rigid;
}

/// In double precision if the eye is far away; otherwise rounding would shift all points.
Mat4 view_from_world(const Affine& rigid, float pullback) {
    if (pullback == 0) {
        return glm::inverse(to_mat4(rigid));
    }
    const glm::dmat4 inverse = glm::inverse(glm::dmat4(to_mat4(rigid)));
    return glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -pullback)) * inverse;
}

Affine pulled_back(Affine rigid, float pullback) {
    for (Vec4& row : rigid.row) {
        row.w += pullback * row.z;
    }
    return rigid;
}

}  // namespace

Affine mix_affine(const Affine& previous, const Affine& current, float alpha) {
    Affine mixed;
    for (int i = 0; i < 3; ++i) {
        mixed.row[i] = previous.row[i] + alpha * (current.row[i] - previous.row[i]);
    }
    return mixed;
}

Affine world_at(
    const StepJumps* jumps, Entity entity, const WorldTransform& now,
    const PreviousWorldTransform* previous, const StepTime& time) {
    if (previous == nullptr || (time.shown == 1.0f && time.alpha == 1.0f)) {
        return now.world;
    }
    const TransformJump* const jump = find_jump(jumps, entity);
    if (jump != nullptr) {
        return time.is_before(jump->at) ? jump->before : now.world;
    }
    return mix_affine(previous->world, now.world, time.alpha);
}

bool is_cut(const Affine& before, const Affine& now) {
    const Vec3 was = normalize_or(column(before, 2), {0, 0, 1});
    const Vec3 is = normalize_or(column(now, 2), {0, 0, 1});
    return glm::dot(was, is) < kMinCosine
           || glm::distance(column(before, 3), column(now, 3)) > kMaxMove;
}

RenderView make_render_view(
    const Camera& camera, const Affine& world_from_camera, const Affine& its_previous,
    const ViewRequest& request) {
    LIMN_CHECK(request.width > 0 && request.height > 0);
    const Affine& previous =
        is_cut(its_previous, world_from_camera) ? world_from_camera : its_previous;

    const bool orthographic = camera.ortho_height > 0;
    const float tangent = orthographic ? 0.5f / kOrthoDistance : std::tan(0.5f * camera.fov_y);
    const float aspect = static_cast<float>(request.width) / static_cast<float>(request.height);
    RenderView view;
    view.width = request.width;
    view.height = request.height;
    view.pullback = orthographic ? kOrthoDistance * camera.ortho_height : 0;
    view.near = view.pullback + camera.near;
    view.tangent = {tangent * aspect, tangent};
    view.alpha = request.alpha;
    view.previous_alpha = request.previous_alpha;

    Mat4 clip_from_view(0.0f);
    clip_from_view[0][0] = 1.0f / view.tangent.x;
    clip_from_view[1][1] = 1.0f / view.tangent.y;
    clip_from_view[2][3] = -1.0f;
    clip_from_view[3][2] = view.near;

    // Without interpolation use the pose itself, so that goldens do not depend on rounding.
    const Affine now = without_scale(
        request.alpha == 1.0f ? world_from_camera
                              : mix_affine(previous, world_from_camera, request.alpha));
    const Affine before =
        without_scale(mix_affine(previous, world_from_camera, request.previous_alpha));
    view.world_from_camera = pulled_back(now, view.pullback);
    view.unjittered_from_world = clip_from_view * view_from_world(now, view.pullback);
    view.previous_clip_from_world = clip_from_view * view_from_world(before, view.pullback);

    return with_jitter(view, request.jitter);
}

RenderView with_jitter(const RenderView& view, const Vec2& jitter) {
    // An offset proportional to w shifts the image equally at all distances.
    Mat4 shift(1.0f);
    shift[3][0] = 2.0f * jitter.x / static_cast<float>(view.width);
    shift[3][1] = 2.0f * jitter.y / static_cast<float>(view.height);
    RenderView jittered = view;
    jittered.jitter = jitter;
    jittered.clip_from_world = shift * view.unjittered_from_world;
    return jittered;
}

RenderView with_lens_sample(const RenderView& view, const Vec2& point) {
    const Vec2 offset = view.lens.aperture_radius * point;
    RenderView sampled = view;
    sampled.lens.aperture_radius = 0;
    for (Vec4& row : sampled.world_from_camera.row) {
        row.w += offset.x * row.x + offset.y * row.y;
    }
    // Moving the eye by `offset` shifts the image of nearer points more; shifting the image back by
    // the shift at the focus distance keeps the focal plane in place.
    const Vec2 moved = offset / view.tangent;
    sampled.unjittered_from_world[3] -= Vec4(moved, 0, 0);
    sampled.previous_clip_from_world[3] -= Vec4(moved, 0, 0);
    const Vec2 half = 0.5f * Vec2(view.width, view.height);
    return with_jitter(sampled, view.jitter + half * moved / view.lens.focus_distance);
}

Vec2 widest_tangent(const RenderView& view) {
    const Vec2 moved = glm::max(glm::abs(view.jitter) - 0.5f, Vec2(0));
    return view.tangent * (1.0f + 2.0f * moved / Vec2(view.width, view.height));
}

LensView lens_view(const World& world, Entity camera) {
    const auto* lens = world.find<Lens>(camera);
    const auto* pinhole = world.find<Camera>(camera);
    if (lens == nullptr || pinhole == nullptr) {
        return {};
    }
    const Result<LensView> made = make_lens_view(*lens, *pinhole);
    if (!made) {
        static std::atomic<bool> reported = false;
        if (!reported.exchange(true)) {
            log_warn("{}; using a pinhole camera", made.error().message);
        }
        return {};
    }
    return *made;
}

RenderView make_render_view(const World& world, Entity camera, const ViewRequest& request) {
    const Affine* current = &world.get<WorldTransform>(camera).world;
    const auto* before = world.find<PreviousWorldTransform>(camera);
    const Affine* previous = before != nullptr ? &before->world : current;
    const TransformJump* const jump = find_jump(world.find_resource<StepJumps>(), camera);
    if (jump != nullptr) {
        current = previous = request.alpha < jump->at ? &jump->before : current;
    }
    Camera lens = world.get<Camera>(camera);
    if (const auto* const framing = world.find<FramingState>(camera)) {
        LIMN_CHECK(request.width > 0 && request.height > 0);
        lens = fit_camera(
            lens, *framing, static_cast<float>(request.width) / static_cast<float>(request.height));
    }
    RenderView view = make_render_view(lens, *current, *previous, request);
    view.cut = jump != nullptr && request.previous_alpha <= jump->at && jump->at <= request.alpha;
    view.lens = lens.ortho_height > 0 ? LensView{} : lens_view(world, camera);
    view.entity = camera;
    return view;
}

std::optional<Entity> find_camera(const World& world, std::string_view name) {
    std::optional<Entity> found;
    if (name.empty()) {
        world.query<const Camera, With<WorldTransform>>().each(
            [&](Entity entity, const Camera& camera) {
                if (!found && camera.active) {
                    found = entity;
                }
            });
    } else {
        world.query<const Name, With<Camera>, With<WorldTransform>>().each(
            [&](Entity entity, const Name& entity_name) {
                if (!found && entity_name.text == name) {
                    found = entity;
                }
            });
    }
    return found;
}

Affine look_at(const Vec3& eye, const Vec3& target) {
    const Vec3 back = normalize_or(eye - target, {0, 0, 1});
    const Vec3 right = normalize_or(glm::cross({0, 1, 0}, back), any_perpendicular(back));
    const Vec3 up = glm::cross(back, right);
    Affine pose;
    for (int i = 0; i < 3; ++i) {
        pose.row[i] = {right[i], up[i], back[i], eye[i]};
    }
    return pose;
}

Vec2 sample_jitter(int index, int count) {
    if (count <= 1) {
        return {0, 0};
    }
    // Fractional parts of multiples of the plastic number's powers, in double: index may be large.
    const double i = index + 0.5;
    const double x = i * 0.7548776662466927;
    const double y = i * 0.5698402909980532;
    return {
        static_cast<float>(x - std::floor(x) - 0.5), static_cast<float>(y - std::floor(y) - 0.5)};
}

}  // namespace limn
