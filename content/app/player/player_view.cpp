// The camera of the window of `limn play`: those of the level, flying, orbiting.

#include "content/app/player/pick.h"
#include "content/app/player/player.h"
#include "ecs/components/animation.h"
#include "ecs/components/framing.h"
#include "ecs/components/motor.h"
#include "ecs/components/name.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace limn {
namespace {

constexpr double kPickInterval = 0.15;  // [s] between measurements of the distance ahead

}  // namespace

RenderView Player::move_camera(float dt, const Input& input, const IVec2& size) {
    const double step = stage_step(*stage_);
    // Right after loading there is only one state, nothing to interpolate.
    const double steps_done = stage_time(*stage_) / step;
    const float alpha =
        paused_ && unsimulated_ == 0.0 ? 1.0f : static_cast<float>(unsimulated_ / step);
    const double shown = steps_done < 0.5 ? 0.0 : stage_time(*stage_) - step + alpha * step;
    const ViewRequest request{
        .width = size.x,
        .height = size.y,
        .alpha = alpha,
        .previous_alpha =
            alpha - static_cast<float>(std::clamp((shown - shown_time_) / step, 0.0, 8.0))};
    view_request_ = request;
    shown_time_ = shown;

    const Entity level_camera = stage_->scene.camera;
    const Camera* lens = std::as_const(stage_->world).find<Camera>(level_camera);
    camera_.lens = lens != nullptr ? *lens : camera_.lens;
    if (const auto* const framing = std::as_const(stage_->world).find<FramingState>(level_camera)) {
        camera_.lens = fit_camera(
            camera_.lens, *framing,
            static_cast<float>(request.width) / static_cast<float>(request.height));
    }
    camera_.previous = camera_.pose;
    const bool placed = std::as_const(stage_->world).has<WorldTransform>(level_camera);
    if (camera_.mode == CameraMode::Level && lens != nullptr && placed) {
        const RenderView view = make_render_view(stage_->world, level_camera, request);
        camera_.pose = view.world_from_camera;
        camera_.started = true;
        return view;
    }
    if (camera_.mode == CameraMode::Orbit) {
        const Vec3 target =
            entity_center(stage_->world, camera_.orbit.target).value_or(camera_.aim);
        step_orbit(camera_, camera_input(input), target, dt);
    } else {
        fly(dt, input);
    }
    RenderView view = make_render_view(camera_.lens, camera_.pose, camera_.previous, request);
    view.lens = lens_view(stage_->world, level_camera);
    view.entity = level_camera;
    return view;
}

void Player::fly(float dt, const Input& input) {
    const MoveInput move = camera_input(input);
    const World& world = stage_->world;
    until_pick_ -= static_cast<double>(dt);
    if (until_pick_ <= 0.0) {
        until_pick_ = kPickInterval;
        const std::optional<Hit> hit = pick_entity(world, ray_through(view_, {0.5f, 0.5f}));
        ahead_ = hit ? hit->distance : INFINITY;
    }
    const Bounds& bounds = stage_->scene.bounds;
    const float radius = is_empty(bounds) ? 10.0f : glm::length(half_extent(bounds));
    update_view_distance(camera_, ahead_, radius, dt);
    step_fly(camera_, move, dt);
    const Vec3 before = transform_point(camera_.previous, {0, 0, 0});
    if (move.move.y >= 0 && camera_.fly_pose.position.y < before.y) {
        const std::optional<Hit> floor = pick_entity(world, {before, {0, -1, 0}});
        stop_at_floor(camera_, floor ? std::optional(floor->distance) : std::nullopt);
    }
}

void Player::orbit_model(const WindowEvents& events, Input& input, bool on_panel) {
    const bool of_model = stage_->scene.model && camera_.mode == CameraMode::Level;
    if (of_model && camera_.started && (input.look != Vec2(0) || input.zoom != 0)) {
        start_orbit(camera_, camera_.pose, model_center());
    }
    const bool pans = window_->is_button_down(GLFW_MOUSE_BUTTON_RIGHT)
                      || window_->is_button_down(GLFW_MOUSE_BUTTON_MIDDLE);
    if (camera_.mode == CameraMode::Orbit && pans && !on_panel) {
        if (const auto center = entity_center(stage_->world, camera_.orbit.target)) {
            camera_.aim = *center;
            camera_.orbit.target = {};
        }
        pan_orbit(camera_, events.mouse_motion, static_cast<float>(window_->framebuffer_size().y));
        input.look = {0, 0};
    }
}

Vec3 Player::model_center() const {
    const LoadedScene& scene = stage_->scene;
    const Bounds& box = scene.model ? scene.model->subject : scene.bounds;
    return is_empty(box) ? Vec3(0) : center(box);
}

void Player::focus_under_pointer() {
    const Ray ray = pointer_ray();
    const std::optional<Hit> hit = pick_entity(stage_->world, ray);
    if (!hit) {
        return;
    }
    if (camera_.mode != CameraMode::Orbit) {
        start_orbit(camera_, camera_.pose, model_center());
    }
    camera_.orbit.target = {};
    camera_.aim = ray.origin + hit->distance * ray.direction;
}

void Player::focus_selection() {
    Entity selected = inspector_.selected();
    if (selected.is_null()) {  // the character whose skeleton is shown
        selected = skeleton_.character();
    }
    const std::optional<Vec3> center = entity_center(stage_->world, selected);
    if (!center) {
        hud_->toast("nothing is selected: click an object, or choose one in the inspector (F2)");
        return;
    }
    start_orbit(camera_, camera_.pose, *center);
    camera_.orbit.target = selected;
    const Bounds box = entity_bounds(stage_->world, selected);
    if (!is_empty(box)) {
        camera_.orbit.distance = framing_distance(
            camera_, glm::length(half_extent(box)),
            static_cast<float>(view_request_.width) / static_cast<float>(view_request_.height));
    }
}

void Player::place_prefab(const std::string& prefab) {
    constexpr float kAhead = 5.0f;  // [m] if nothing is there
    const Ray ray = ray_through(view_, {0.5f, 0.5f});
    const std::optional<Hit> hit = pick_entity(stage_->world, ray);
    const float distance = hit ? hit->distance : kAhead;
    hud_->toast(inspector_.place(stage_->world, prefab, ray.origin + distance * ray.direction));
}

void Player::edit_furrows() {
    furrows_.open(stage_->world, inspector_.selected());
    focus_selection();
}

void Player::toggle_skeleton() {
    Entity character = find_character(stage_->world, inspector_.selected());
    if (character.is_null()) {
        stage_->world.query<const Hero, With<Skeleton>>().each(
            [&](Entity hero, const Hero&) { character = character.is_null() ? hero : character; });
    }
    if (skeleton_.is_open()) {
        skeleton_.close();
    } else if (character.is_null()) {
        hud_->toast("click a character or choose it in the inspector (F2), then press Shift F2");
    } else {
        skeleton_.open(character);
    }
}

void Player::toggle_markers() {
    if (markers_.is_open()) {
        markers_.close();
    } else if (const Status opened = open_markers(); !opened) {
        hud_->toast(opened.error().message, ToastKind::Bad);
    }
}

Status Player::open_markers() {
    LIMN_TRY(markers_.open(stage_->world, inspector_.selected()));
    model_panel_.open = false;
    if (const auto* lens = std::as_const(stage_->world).find<Camera>(stage_->scene.camera)) {
        camera_.lens = *lens;
    }
    if (const auto face = markers_.find_face(stage_->world)) {
        const IVec2 size = glm::max(window_->framebuffer_size(), IVec2(1));
        const float distance = framing_distance(
            camera_, face->radius, static_cast<float>(size.x) / static_cast<float>(size.y));
        start_orbit(
            camera_, look_at(face->center + distance * face->front, face->center), face->center);
    }
    return Done{};
}

void Player::face_furrows() {
    World& world = stage_->world;
    const auto* const transform = std::as_const(world).find<WorldTransform>(furrows_.entity());
    const std::optional<Vec3> center = entity_center(world, furrows_.entity());
    if (transform == nullptr || !center) {
        return;
    }
    const Vec3 front = normalize_or(transform_vector(transform->world, {0, 0, 1}), {0, 0, 1});
    const float distance = camera_.orbit.distance;
    start_orbit(camera_, look_at(*center + distance * front, *center), *center);
    face_light(world, inspector_.undo_stack(), *center, front);
}

void Player::go_home() {
    camera_.mode = CameraMode::Level;
    activate_camera(0);
    hud_->toast(camera_mode_name(camera_.mode));
}

void Player::cycle_camera() {
    switch (camera_.mode) {
    case CameraMode::Level:
        if (next_level_camera()) {
            return;
        }
        start_fly(camera_, camera_.pose);
        break;
    case CameraMode::Fly: {
        camera_.orbit.target = inspector_.selected();
        start_orbit(
            camera_, camera_.pose,
            entity_center(stage_->world, camera_.orbit.target).value_or(model_center()));
        break;
    }
    case CameraMode::Orbit:
        go_home();
        return;
    }
    hud_->toast(camera_mode_name(camera_.mode));
}

bool Player::next_level_camera() {
    const std::vector<Entity> cameras = level_cameras();
    const auto now = std::find(cameras.begin(), cameras.end(), stage_->scene.camera);
    const auto next = static_cast<std::size_t>(now - cameras.begin()) + 1;
    if (next >= cameras.size()) {
        return false;
    }
    activate_camera(next);
    const auto* name = std::as_const(stage_->world).find<Name>(stage_->scene.camera);
    if (const ActionGroup* const driver = driving_group(stage_->world, stage_->scene.camera)) {
        hud_->toast(
            describe_group(*driver, std::as_const(stage_->world).find_resource<Bindings>()));
    } else {
        hud_->toast(name != nullptr ? name->text : "scene camera");
    }
    return true;
}

std::vector<Entity> Player::level_cameras() {
    std::vector<Entity> cameras;
    stage_->world.query<const Camera>().each(
        [&](Entity entity, const Camera&) { cameras.push_back(entity); });
    std::sort(cameras.begin(), cameras.end(), [](Entity a, Entity b) { return a.index < b.index; });
    const auto first = std::find(cameras.begin(), cameras.end(), first_camera_);
    if (first != cameras.end()) {
        std::rotate(cameras.begin(), first, first + 1);
    }
    return cameras;
}

void Player::activate_camera(std::size_t index) {
    const std::vector<Entity> cameras = level_cameras();
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        stage_->world.get<Camera>(cameras[i]).active = i == index;
    }
    if (index < cameras.size()) {
        stage_->scene.camera = cameras[index];
    }
}

}  // namespace limn
