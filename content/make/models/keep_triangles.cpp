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

/// `old`: number of vertices before.
void gather_morph(MorphTarget& morph, const std::vector<std::uint32_t>& source, std::size_t old) {
    std::vector<std::uint32_t> entry(old, kUnused);  // of the target's lists, by vertex
    for (std::uint32_t i = 0; i < morph.vertices.size(); ++i) {
        entry[morph.vertices[i]] = i;
    }
    std::vector<std::uint32_t> entries;
    std::vector<std::uint32_t> vertices;  // still sorted
    for (std::uint32_t v = 0; v < source.size(); ++v) {
        if (entry[source[v]] != kUnused) {
            entries.push_back(entry[source[v]]);
            vertices.push_back(v);
        }
    }
    gather(morph.positions, entries);
    gather(morph.normals, entries);
    gather(morph.tangents, entries);
    morph.vertices = std::move(vertices);
}

}  // namespace

void gather_vertices(MeshData& mesh, const std::vector<std::uint32_t>& source) {
    const std::size_t old = mesh.positions.size();
    gather(mesh.positions, source);
    gather(mesh.normals, source);
    gather(mesh.tangents, source);
    gather(mesh.uvs, source);
    gather(mesh.uvs1, source);
    gather(mesh.colors, source);
    gather_influences(mesh.skin, source);
    for (MorphTarget& morph : mesh.morphs) {
        gather_morph(morph, source, old);
    }
    for (VertexRegion& region : mesh.regions) {
        gather(region.weights, source);
        gather(region.across, source);
    }
}

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
    gather_vertices(mesh, source);
}

}  // namespace limn
