#include "content/make/head.h"

#include "content/bake/face_regions.h"
#include "content/bake/tangents.h"
#include "content/make/head_layout.h"
#include "content/make/head_surface.h"
#include "content/make/head_wrap.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace limn {

namespace {

constexpr float kMeters = 0.01f;  ///< per centimeter

float spot(const Vec3& p, const Vec3& center, float radius) {
    const Vec3 offset = p - center;
    return std::exp(-glm::dot(offset, offset) / square(radius));
}

/// Factor of the material's color at rest position `p` [cm].
Vec3 skin_color(const HeadVertex& vertex, const Vec3& point) {
    const Vec3 p = {std::abs(point.x), point.y, point.z};
    Vec3 color = Vec3(1);
    const float flush = std::min(
        1.0f, 0.8f * spot(p, {4.4f, -0.2f, 8.6f}, 2.4f) + spot(p, {0, 0.2f, 12}, 1.5f)
                  + (vertex.loops == HeadLoops::Ear ? 0.9f : 0.0f)
                  + 0.4f * spot(p, {0, -6.3f, 10.2f}, 1.6f));
    color = glm::mix(color, Vec3(1.0f, 0.80f, 0.76f), flush);
    color = glm::mix(color, Vec3(0.83f, 0.76f, 0.78f), 0.6f * spot(p, {2.6f, 2.0f, 9.2f}, 0.9f));
    if (vertex.loops == HeadLoops::Mouth) {
        const float arch = std::sqrt(std::max(1 - square(p.x / 2.45f), 0.0f));
        const float bow = 0.14f * spot({p.x, 0, 0}, {0, 0, 0}, 0.3f);
        const float edge = p.y > -3.3f ? 0.85f * arch - bow : arch;
        const float lips = 1 - glm::smoothstep(edge - 0.14f, edge + 0.06f, std::abs(p.y + 3.3f));
        color = glm::mix(color, Vec3(0.86f, 0.52f, 0.52f), lips);
        if (vertex.loop > kLipLoop + 1) {
            color = Vec3(0.45f, 0.2f, 0.2f);
        }
    }
    if (vertex.loops == HeadLoops::Eye) {
        if (vertex.loop >= kLidLoop) {
            color = Vec3(0.95f, 0.62f, 0.58f);
        }
    }
    return color;
}

MeshData make_skin(const HeadShape& shape) {
    const HeadLayout& layout = head_layout();
    const std::vector<Vec3> positions = wrap_head(shape);
    MeshData mesh;
    mesh.name = "head";
    std::vector<std::uint32_t> source;
    std::map<std::pair<std::uint32_t, bool>, std::uint32_t> made;  // copies beyond the seam
    const auto vertex_at = [&](std::uint32_t v, bool beyond) {
        const auto [found, added] =
            made.try_emplace({v, beyond}, static_cast<std::uint32_t>(source.size()));
        if (added) {
            source.push_back(v);
            const Vec2 chart = layout.vertices[v].chart + Vec2(beyond ? kHeadColumns : 0, 0);
            mesh.positions.push_back(kMeters * positions[v]);
            mesh.uvs.push_back({0.5f + chart.x / kHeadColumns, (chart.y + 13) / (kHeadRows + 13)});
            mesh.colors.emplace_back(skin_color(layout.vertices[v], positions[v]), 1.0f);
        }
        return found->second;
    };
    for (const auto& quad : layout.quads) {
        float high = -kHeadColumns;
        for (const std::uint32_t v : quad) {
            high = std::max(high, layout.vertices[v].chart.x);
        }
        std::array<std::uint32_t, 4> corners{};
        for (int k = 0; k < 4; ++k) {
            const bool beyond = layout.vertices[quad[k]].chart.x < high - 0.5f * kHeadColumns;
            corners[k] = vertex_at(quad[k], beyond);
        }
        for (const int k : {0, 1, 2, 0, 2, 3}) {
            mesh.indices.push_back(corners[k]);
        }
    }
    generate_normals(mesh);
    // Ears, and what lies behind lids and lips, are no skin of the face.
    std::vector<Vec3> reference;
    for (const std::uint32_t v : source) {
        const HeadVertex& vertex = layout.vertices[v];
        const bool face = vertex.loops == HeadLoops::None
                          || (vertex.loops == HeadLoops::Eye && vertex.loop <= kLidLoop)
                          || (vertex.loops == HeadLoops::Mouth && vertex.loop <= kLipLoop);
        reference.push_back(face ? positions[v] : Vec3(std::numeric_limits<float>::quiet_NaN()));
    }
    mesh.regions = make_face_regions(reference, mesh.normals);
    return mesh;
}

}  // namespace

MeshData make_head(const HeadShape& shape) {
    MeshData mesh = make_skin(shape);
    generate_tangents(mesh);
    update_bounds(mesh);
    return mesh;
}

}  // namespace limn
