#include "content/load/model_ground.h"

#include "content/load/gltf/gltf_scene.h"
#include "content/load/model_view.h"
#include "content/load/scene_bounds.h"
#include "ecs/components/animation.h"
#include "ecs/components/name.h"
#include "ecs/components/shadow.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace limn {
namespace {

constexpr float kGroundRadius = 6.0f;  // of the subject's
constexpr float kFadeRadius = 12.0f;   // of the subject's, for a ground in the file; by eye
constexpr float kFlatGround = 0.02f;   // height of a ground / width
constexpr float kEdgeLength = 0.35f;   // of the distance from the subject's center
constexpr std::size_t kMaxCorners = 300'000;

/// A disc whose vertices fade from opaque to transparent.
MeshData make_ground(float radius) {
    constexpr int kSegments = 96;
    constexpr int kRings = 24;
    MeshData mesh;
    mesh.name = "ground";
    for (int ring = 0; ring <= kRings; ++ring) {
        const float t = static_cast<float>(ring) / kRings;
        const float opacity = square(square(1 - square(t)));
        for (int i = 0; i < kSegments; ++i) {
            const float angle = 2 * kPi * static_cast<float>(i) / kSegments;
            mesh.positions.push_back(radius * t * Vec3(std::cos(angle), 0, -std::sin(angle)));
            mesh.normals.push_back({0, 1, 0});
            mesh.tangents.push_back({1, 0, 0, 1});
            mesh.uvs.push_back({0, 0});
            mesh.colors.push_back({1, 1, 1, opacity});
        }
    }
    for (std::uint32_t ring = 0; ring < kRings; ++ring) {
        for (std::uint32_t i = 0; i < kSegments; ++i) {
            const std::uint32_t a = ring * kSegments + i;
            const std::uint32_t b = ring * kSegments + (i + 1) % kSegments;
            if (ring > 0) {
                mesh.indices.insert(mesh.indices.end(), {a, b + kSegments, b});
            }
            mesh.indices.insert(mesh.indices.end(), {a, a + kSegments, b + kSegments});
        }
    }
    mesh.bounds = {{-radius, 0, -radius}, {radius, 0, radius}};
    return mesh;
}

/// Subdivides the triangles of a ground until opacity per vertex is smooth.
class FadingGround {
  public:
    FadingGround(const MeshData& mesh, const Affine& world_from_mesh, const Bounds& subject)
        : mesh_(mesh), world_from_mesh_(world_from_mesh), center_(center(subject)),
          radius_(glm::length(half_extent(subject))) {
        mesh_.colors.resize(mesh_.positions.size(), Vec4(1));
        for (const Vec3& position : mesh_.positions) {
            offsets_.push_back(offset_of(position));
        }
    }

    MeshData make() {
        std::vector<std::uint32_t> waiting = std::exchange(mesh_.indices, {});
        while (!waiting.empty()) {
            std::array<std::uint32_t, 3> t;
            for (std::size_t i = 3; i-- > 0;) {
                t[i] = waiting.back();
                waiting.pop_back();
            }
            int longest = 0;
            for (int edge = 1; edge < 3; ++edge) {
                longest = length(t, edge) > length(t, longest) ? edge : longest;
            }
            const float size = length(t, longest);
            const Vec2 centroid = (offsets_[t[0]] + offsets_[t[1]] + offsets_[t[2]]) / 3.0f;
            const float nearest = std::max(glm::length(centroid) - size, 0.0f);
            if (nearest > kFadeRadius * radius_) {
                continue;  // completely transparent
            }
            const bool full = mesh_.indices.size() + waiting.size() > kMaxCorners;
            if (size <= kEdgeLength * std::max(nearest, radius_) || full) {
                mesh_.indices.insert(mesh_.indices.end(), t.begin(), t.end());
                continue;
            }
            const std::uint32_t a = t[static_cast<std::size_t>(longest)];
            const std::uint32_t b = t[static_cast<std::size_t>((longest + 1) % 3)];
            const std::uint32_t c = t[static_cast<std::size_t>((longest + 2) % 3)];
            const std::uint32_t half = halve(a, b);
            waiting.insert(waiting.end(), {a, half, c, half, b, c});
        }
        for (std::size_t i = 0; i < offsets_.size(); ++i) {
            const float t = std::min(glm::length(offsets_[i]) / (kFadeRadius * radius_), 1.0f);
            mesh_.colors[i].w *= square(1 - square(t));
        }
        return std::move(mesh_);
    }

  private:
    [[nodiscard]] Vec2 offset_of(const Vec3& position) const {
        const Vec3 p = transform_point(world_from_mesh_, position) - center_;
        return {p.x, p.z};
    }
    [[nodiscard]] float length(const std::array<std::uint32_t, 3>& t, int edge) const {
        return glm::length(
            offsets_[t[static_cast<std::size_t>((edge + 1) % 3)]]
            - offsets_[t[static_cast<std::size_t>(edge)]]);
    }

    /// The vertex at the midpoint of an edge.
    std::uint32_t halve(std::uint32_t a, std::uint32_t b) {
        const auto next = static_cast<std::uint32_t>(mesh_.positions.size());
        const auto [found, is_new] = halves_.try_emplace(std::minmax(a, b), next);
        if (!is_new) {
            return found->second;
        }
        const auto append_mean = [&](auto& values) {
            if (!values.empty()) {
                values.push_back(0.5f * (values[a] + values[b]));
            }
        };
        append_mean(mesh_.positions);
        append_mean(mesh_.uvs);
        append_mean(mesh_.uvs1);
        append_mean(mesh_.colors);
        append_mean(mesh_.normals);
        mesh_.normals.back() = normalize_or(mesh_.normals.back(), mesh_.normals[a]);
        mesh_.tangents.push_back(mesh_.tangents[a]);
        offsets_.push_back(offset_of(mesh_.positions.back()));
        return next;
    }

    MeshData mesh_;
    Affine world_from_mesh_;
    Vec3 center_;                ///< of the subject
    float radius_;               ///< of the subject [m]
    std::vector<Vec2> offsets_;  ///< x and z of each vertex from the center, in the world [m]
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> halves_;
};

}  // namespace

void add_ground(World& world, ModelView& view) {
    const float radius = glm::length(half_extent(view.subject));
    auto& assets = world.resource<Assets>();
    const MaterialId material = {static_cast<std::uint32_t>(assets.materials.size())};
    assets.materials.push_back(
        {.name = "ground",
         .shading = ShadingModel::Blinn,  // opacity does not weaken reflections, so it has none
         .alpha_mode = AlphaMode::Blend,
         .base_color = {0.22f, 0.22f, 0.228f, 1},
         .specular = {0, 0, 0}});
    const MeshId mesh = {static_cast<std::uint32_t>(assets.meshes.size())};
    assets.meshes.push_back(make_ground(kGroundRadius * radius));
    ++view.meshes;
    ++view.materials;
    Vec3 ground_center = center(view.subject);
    ground_center.y = view.subject.min.y - 1e-3f * radius;
    view.added.push_back(world.create(
        Name{"ground"}, Transform{.position = ground_center},
        MeshInstance{.mesh = mesh, .material = material}, NoShadow{}));
}

void fade_grounds(World& world, std::span<const Entity> scenery, ModelView& view) {
    const SceneMatrices matrices(world);
    auto& assets = world.resource<Assets>();
    const float radius = glm::length(half_extent(view.subject));
    for (const Entity entity : scenery) {
        const MeshInstance instance = world.get<const MeshInstance>(entity);
        const MeshData& mesh = assets.meshes[instance.mesh.index];
        const Affine matrix = matrices.of(entity);
        const Vec3 half = half_extent(transform_bounds(matrix, mesh.bounds));
        if (half.y > kFlatGround * std::max(half.x, half.z)
            || std::max(half.x, half.z) < kFadeRadius * radius || radius <= 0
            || world.has<Deformed>(entity) || instance.material.index >= assets.materials.size()
            || assets.materials[instance.material.index].alpha_mode != AlphaMode::Opaque
            || is_see_through(assets.materials[instance.material.index])) {
            continue;
        }
        Material material = assets.materials[instance.material.index];
        material.name += " fading";
        material.shading = ShadingModel::Blinn;
        material.alpha_mode = AlphaMode::Blend;
        material.specular = {0, 0, 0};
        MeshData faded = FadingGround(mesh, matrix, view.subject).make();
        faded.name += " fading";
        world.get<MeshInstance>(entity) = {
            {static_cast<std::uint32_t>(assets.meshes.size())},
            {static_cast<std::uint32_t>(assets.materials.size())}};
        assets.meshes.push_back(std::move(faded));
        assets.materials.push_back(std::move(material));
        ++view.meshes;
        ++view.materials;
        if (!world.has<NoShadow>(entity)) {
            world.add(entity, NoShadow{});
        }
    }
}

}  // namespace limn
