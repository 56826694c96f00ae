#include "content/make/models/keep_triangles.h"

#include "ecs/components/surface.h"

#include <utility>

namespace limn {

namespace {

constexpr std::uint32_t kUnused = 0xffffffffu;

/// Replaces `values` by values[source[i]] for all i.
template <typename T>
void gather(std::vector<T>& values, const std::vector<std::uint32_t>& source) {
    if (values.empty()) {
        return;
    }
    std::vector<T> kept;
    kept.reserve(source.size());
    for (const std::uint32_t index : source) {
        kept.push_back(values[index]);
    }
    values = std::move(kept);
}

void gather_influences(SkinWeights& skin, const std::vector<std::uint32_t>& source) {
    if (skin.empty()) {
        return;
    }
    SkinWeights kept;
    for (const std::uint32_t v : source) {
        kept.first.push_back(static_cast<std::uint32_t>(kept.joints.size()));
        for (std::uint32_t i = skin.first[v]; i < skin.first[v + 1]; ++i) {
            kept.joints.push_back(skin.joints[i]);
            kept.weights.push_back(skin.weights[i]);
        }
    }
    kept.first.push_back(static_cast<std::uint32_t>(kept.joints.size()));
    skin = std::move(kept);
}

void gather_morph(MorphTarget& morph, const std::vector<std::uint32_t>& number) {
    std::vector<std::uint32_t>
        source;  // indices into the lists of the target, still sorted by vertex
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t i = 0; i < morph.vertices.size(); ++i) {
        if (number[morph.vertices[i]] != kUnused) {
            source.push_back(i);
            vertices.push_back(number[morph.vertices[i]]);
        }
    }
    gather(morph.positions, source);
    gather(morph.normals, source);
    gather(morph.tangents, source);
    morph.vertices = std::move(vertices);
}

}  // namespace

void keep_triangles(MeshData& mesh, std::vector<std::uint32_t> indices) {
    std::vector<std::uint32_t> number(mesh.positions.size(), kUnused);
    for (const std::uint32_t index : indices) {
        number[index] = 0;
    }
    std::vector<std::uint32_t> source;
    for (std::uint32_t v = 0; v < number.size(); ++v) {
        if (number[v] != kUnused) {
            number[v] = static_cast<std::uint32_t>(source.size());
            source.push_back(v);
        }
    }
    for (std::uint32_t& index : indices) {
        index = number[index];
    }
    mesh.indices = std::move(indices);
    mesh.pieces.clear();
    gather(mesh.positions, source);
    gather(mesh.normals, source);
    gather(mesh.tangents, source);
    gather(mesh.uvs, source);
    gather(mesh.uvs1, source);
    gather(mesh.colors, source);
    gather_influences(mesh.skin, source);
    for (MorphTarget& morph : mesh.morphs) {
        gather_morph(morph, number);
    }
    for (VertexRegion& region : mesh.regions) {
        gather(region.weights, source);
        gather(region.across, source);
    }
}

}  // namespace limn
