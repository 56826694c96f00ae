#include "content/app/player/skeleton_overlay.h"

#include "content/app/player/label_layout.h"
#include "content/app/player/pose_gizmo.h"
#include "content/app/player/world_lines.h"
#include "content/load/motion/ghost_figure.h"
#include "ecs/base/rotation.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

// Techniques: char.fk-keypose, char.ghost-view

namespace limn {
namespace {

constexpr Vec3 kBoneColor = {0.95f, 0.95f, 0.9f};
constexpr Vec3 kSelectedColor = {1.0f, 0.75f, 0.2f};

Vec3 joint_position(const Affine& world, const Affine& joint) {
    return transform_point(world, transform_point(joint, Vec3(0)));
}

void draw_bones(
    WorldLines& lines, const SkeletonData& skeleton, const Affine& world,
    std::span<const Affine> joints, float width) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const std::int32_t parent = skeleton.parents[j];
        if (parent >= 0) {
            lines.draw_line(
                joint_position(world, joints[static_cast<std::size_t>(parent)]),
                joint_position(world, joints[j]), width);
        }
    }
}

/// A length for marks at a joint: of the bones at it, within bounds relative to the skeleton.
float mark_length(const CharacterView& character, std::size_t joint, float size) {
    float longest = 0;
    for (std::size_t j = 0; j < character.joints.size(); ++j) {
        if (character.skeleton->parents[j] == static_cast<std::int32_t>(joint)) {
            longest = std::max(
                longest, glm::distance(
                             transform_point(character.joints[j], Vec3(0)),
                             transform_point(character.joints[joint], Vec3(0))));
        }
    }
    return std::clamp(0.3f * longest, 0.012f * size, 0.06f * size);
}

float size_of_skeleton(const CharacterView& character) {
    Bounds box;
    for (const Affine& joint : character.joints) {
        grow(box, transform_point(joint, Vec3(0)));
    }
    return is_empty(box) ? 1.0f : std::max(glm::length(box.max - box.min), 1e-3f);
}

void draw_axes(const RenderView& view, const CharacterView& character, float size) {
    for (int a = 0; a < 3; ++a) {
        WorldLines lines(view, kAxisColors[static_cast<std::size_t>(a)]);
        for (std::size_t j = 0; j < character.joints.size(); ++j) {
            const Affine world = character.world_from_character * character.joints[j];
            Vec3 unit(0);
            unit[a] = 1;
            const Vec3 from = transform_point(world, Vec3(0));
            const Vec3 along = normalize_or(transform_vector(world, unit), unit);
            lines.draw_line(from, from + mark_length(character, j, size) * along);
        }
    }
}

/// Arcs about the axes of a joint, each turned by the angles of the axes before it.
void draw_limits_of(
    WorldLines& lines, const CharacterView& character, std::uint16_t joint, float radius) {
    const SkeletonData& skeleton = *character.skeleton;
    const std::vector<JointAngle> angles =
        joint_angles(skeleton, joint, shown_turn(skeleton, character.joints, joint));
    const std::int32_t parent = skeleton.parents[joint];
    const Affine above = parent < 0 ? character.world_from_character
                                    : character.world_from_character
                                          * character.joints[static_cast<std::size_t>(parent)];
    const Vec3 center = joint_position(character.world_from_character, character.joints[joint]);
    Quat base = skeleton.rest.rotations[joint];
    for (const JointAngle& angle : angles) {
        if (!angle.is_limited) {
            return;
        }
        const Vec3 start = any_perpendicular(angle.axis);
        const auto at = [&](float value, float scale) {
            const Vec3 along = base * (rotation_about(angle.axis, value) * start);
            return center + scale * radius * normalize_or(transform_vector(above, along), along);
        };
        constexpr int kArcLines = 24;
        for (int i = 0; i < kArcLines; ++i) {
            const float u = static_cast<float>(i) / kArcLines;
            const float step = (angle.max - angle.min) / kArcLines;
            lines.draw_line(
                at(glm::mix(angle.min, angle.max, u), 1),
                at(glm::mix(angle.min, angle.max, u) + step, 1));
        }
        lines.draw_line(center, at(angle.min, 1));
        lines.draw_line(center, at(angle.max, 1));
        lines.draw_line(center, at(angle.value, 1.25f), 3.0f);
        base = base * rotation_about(angle.axis, angle.value);
    }
}

void draw_limits(const RenderView& view, const CharacterView& character, int selected, float size) {
    WorldLines lines(view, kLimitColor);
    for (std::uint16_t j = 0; j < character.joints.size(); ++j) {
        if (selected < 0 || selected == static_cast<int>(j)) {
            const float radius = mark_length(character, j, size);
            draw_limits_of(lines, character, j, selected < 0 ? radius : 2 * radius);
        }
    }
}

void draw_ghosts(
    const RenderView& view, const CharacterView& character, const MotionHistory& history,
    const SkeletonOverlay& overlay) {
    const auto count = static_cast<std::size_t>(std::max(overlay.ghosts, 0));
    for (std::size_t ghost = 0; ghost < count; ++ghost) {
        // From the farthest to the nearest, which is on top.
        const float offset = static_cast<float>(count - ghost) * overlay.ghost_step;
        for (const float sign : {-1.0f, 1.0f}) {
            if (const auto moment = moment_at(character, history, sign * offset)) {
                WorldLines lines(
                    view, sign < 0 ? kPastColor : kFutureColor, ghost_opacity(ghost, count));
                draw_bones(
                    lines, *character.skeleton, moment->world_from_character, moment->joints, 2.0f);
            }
        }
    }
}

void draw_trails(
    const RenderView& view, const CharacterView& character, const MotionHistory& history,
    const SkeletonOverlay& overlay) {
    for (const std::uint16_t joint : overlay.trails) {
        for (const bool is_past : {true, false}) {
            const std::vector<Vec3> trail = trail_of(
                character, history, joint, is_past ? overlay.trail : 0,
                is_past ? 0 : overlay.trail);
            WorldLines lines(view, is_past ? kPastColor : kFutureColor);
            for (std::size_t i = 1; i < trail.size(); ++i) {
                lines.draw_line(trail[i - 1], trail[i], 2.0f);
                if (i % 6 == 0) {  // a tenth of a second
                    lines.draw_point(trail[i], 2.5f);
                }
            }
        }
    }
}

/// Names of joints where there is room: of the selected one first, then those of long bones.
void draw_names(
    const RenderView& view, const CharacterView& character, const SkeletonOverlay& overlay,
    float size) {
    struct Name {
        float rank;
        std::size_t joint;
    };
    std::vector<Name> names;
    for (std::size_t j = 0; j < character.joints.size(); ++j) {
        const bool is_selected = overlay.selected == static_cast<int>(j);
        if (overlay.names || is_selected) {
            names.push_back({is_selected ? INFINITY : mark_length(character, j, size), j});
        }
    }
    std::ranges::stable_sort(names, std::ranges::greater{}, &Name::rank);
    Vec3 center(0);
    for (const Affine& joint : character.joints) {
        center += joint_position(character.world_from_character, joint);
    }
    center /= static_cast<float>(std::max<std::size_t>(character.joints.size(), 1));
    LabelLayout layout(find_pixel(view, center).value_or(Vec2(0)).x);
    WorldLines bones(view, kBoneColor);
    WorldLines marked(view, kSelectedColor);
    for (const Name& name : names) {
        (name.rank == INFINITY ? marked : bones)
            .draw_label(
                joint_position(character.world_from_character, character.joints[name.joint]),
                character.skeleton->joints[name.joint], layout);
    }
}

}  // namespace

void draw_skeleton_overlay(
    const RenderView& view, const CharacterView& character, const MotionHistory& history,
    const SkeletonOverlay& overlay) {
    const float size = size_of_skeleton(character);
    draw_ghosts(view, character, history, overlay);
    draw_trails(view, character, history, overlay);
    if (overlay.limits) {
        draw_limits(view, character, overlay.selected, size);
    }
    if (overlay.axes) {
        draw_axes(view, character, size);
    }
    WorldLines bones(view, kBoneColor);
    WorldLines marked(view, kSelectedColor);
    if (overlay.bones) {
        draw_bones(
            bones, *character.skeleton, character.world_from_character, character.joints, 2.0f);
    }
    for (std::size_t j = 0; j < character.joints.size(); ++j) {
        const bool is_selected = overlay.selected == static_cast<int>(j);
        if (overlay.bones || overlay.names || is_selected) {
            (is_selected ? marked : bones)
                .draw_point(
                    joint_position(character.world_from_character, character.joints[j]),
                    is_selected ? 5.0f : 2.5f);
        }
    }
    draw_names(view, character, overlay, size);
}

void draw_gizmo(const RenderView& view, const PoseGizmo& gizmo, int held) {
    constexpr int kGizmoLines = 64;
    for (int axis = 0; axis < 3; ++axis) {
        WorldLines lines(view, kAxisColors[static_cast<std::size_t>(axis)]);
        for (int i = 0; i < kGizmoLines; ++i) {
            const float step = 2 * kPi / kGizmoLines;
            const float angle = static_cast<float>(i) * step;
            lines.draw_line(
                ring_point(gizmo, axis, angle), ring_point(gizmo, axis, angle + step),
                axis == held ? 4.0f : 2.0f);
        }
    }
}

}  // namespace limn
