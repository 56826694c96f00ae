#include "systems/water/shoaling_system.h"

#include "systems/water/water_refraction.h"

#include <algorithm>
#include <cmath>

// Techniques: water.noise-surface, water.shallow-refraction

namespace limn {
namespace {

DepthGrid make_bottom(const ShoalingWaves& waves) {
    const auto points = static_cast<int>(waves.points);
    DepthGrid grid{.points = {points, points}, .cell = waves.size.x / float(points - 1)};
    for (int j = 0; j < points; ++j) {
        for (int i = 0; i < points; ++i) {
            const Vec2 at = (Vec2(i, j) / float(points - 1) - 0.5f) * waves.size;
            const float u = std::min(glm::length(at) / std::max(waves.shoal_radius, 1e-6f), 1.0f);
            const float blend = 1.0f - u * u * (3.0f - 2.0f * u);
            grid.depth.push_back(glm::mix(waves.depth, waves.shoal_depth, blend));
        }
    }
    return grid;
}

/// Normals by central differences, one-sided at the border.
void fill_normals(HeightField& field) {
    const int points = static_cast<int>(field.points);
    const Vec2 cell = field.size / float(points - 1);
    const auto at = [&](int i, int j) {
        return field.height[static_cast<std::size_t>(
            std::clamp(j, 0, points - 1) * points + std::clamp(i, 0, points - 1))];
    };
    for (int j = 0; j < points; ++j) {
        for (int i = 0; i < points; ++i) {
            const Vec2 rise = {at(i + 1, j) - at(i - 1, j), at(i, j + 1) - at(i, j - 1)};
            const Vec3 normal = {-rise.x * cell.y, 2 * cell.x * cell.y, -rise.y * cell.x};
            field.normal[static_cast<std::size_t>(j * points + i)] =
                normalize_or(normal, Vec3(0, 1, 0));
        }
    }
}

void fill_heights(const ShoalingState& state, double time, HeightField& field) {
    const ShoalingWaves& waves = state.settings;
    field.points = waves.points;
    field.size = waves.size;
    field.height.resize(state.phase.size());
    field.normal.resize(state.phase.size());
    const auto turn = static_cast<float>(std::fmod(state.frequency * time, 2.0 * M_PI));
    for (std::size_t i = 0; i < state.phase.size(); ++i) {
        field.height[i] = waves.amplitude * std::cos(state.phase[i] - turn);
    }
    const auto [low, high] = std::minmax_element(field.height.begin(), field.height.end());
    field.low = *low;
    field.range = *high - *low;
    fill_normals(field);
}

void shape_mesh(const HeightField& field, MeshData& mesh) {
    const auto last = static_cast<float>(field.points - 1);
    bool has_changed = false;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        Vec3& position = mesh.positions[v];
        const Vec2 uv = glm::clamp(Vec2(position.x, position.z) / field.size + 0.5f, 0.0f, 1.0f);
        const auto i = static_cast<std::size_t>(std::lround(uv.x * last));
        const auto j = static_cast<std::size_t>(std::lround(uv.y * last));
        const std::size_t point = j * field.points + i;
        has_changed = has_changed || position.y != field.height[point]
                      || mesh.normals[v] != field.normal[point];
        position.y = field.height[point];
        mesh.normals[v] = field.normal[point];
    }
    if (!has_changed) {
        return;  // uploads nothing
    }
    mesh.bounds.min.y = field.low;
    mesh.bounds.max.y = field.low + field.range;
    ++mesh.version;
}

}  // namespace

void add_shoaling_states(
    Query<const ShoalingWaves, Without<ShoalingState>> bare, Commands commands) {
    bare.each([&](Entity entity, const ShoalingWaves&) {
        commands.add(entity, ShoalingState{});
        commands.add(entity, HeightField{});
    });
}

void update_shoaling_waves(
    Query<const ShoalingWaves, ShoalingState, HeightField> waters, Res<const FrameTime> time) {
    waters.each([&](const ShoalingWaves& waves, ShoalingState& state, HeightField& field) {
        if (state.phase.empty() || state.settings != waves) {
            state.settings = waves;
            state.phase = refract_waves(make_bottom(waves), waves.period, waves.direction).phase;
            state.frequency = 2.0 * M_PI / static_cast<double>(waves.period);
        }
        fill_heights(state, time->time, field);
    });
}

void shape_height_meshes(
    Query<const HeightField, const MeshInstance> surfaces, Res<Assets> assets) {
    surfaces.each([&](const HeightField& field, const MeshInstance& instance) {
        if (instance.mesh.index < assets->meshes.size() && field.points > 1
            && field.height.size() == std::size_t{field.points} * field.points && field.size.x > 0
            && field.size.y > 0) {
            shape_mesh(field, assets->meshes[instance.mesh.index]);
        }
    });
}

}  // namespace limn
