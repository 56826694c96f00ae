#include "content/make/person/person_mesh.h"

#include "content/bake/tangents.h"
#include "content/make/models/keep_triangles.h"
#include "content/make/person/person_weights.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

namespace limn {

std::uint32_t BodyMesh::add(const BodyVertex& vertex) {
    vertices.push_back(vertex);
    return static_cast<std::uint32_t>(vertices.size() - 1);
}

void BodyMesh::add_quad(
    const std::array<std::uint32_t, 4>& corners, const std::array<Vec2, 4>& uvs) {
    quads.push_back({corners, uvs});
}

void BodyMesh::join(const BodyRing& a, const BodyRing& b, float width, float first) {
    const std::size_t count = a.vertices.size();
    const std::size_t columns = a.closed ? count : count - 1;
    for (std::size_t j = 0; j < columns; ++j) {
        const std::size_t next = (j + 1) % count;
        const float u = width * (static_cast<float>(j) - first);
        add_quad(
            {a.vertices[j], b.vertices[j], b.vertices[next], a.vertices[next]},
            {Vec2(u, a.v), Vec2(u, b.v), Vec2(u + width, b.v), Vec2(u + width, a.v)});
    }
}

std::uint32_t BodyMesh::cap(const BodyRing& ring, const Vec3& offset, float width, bool turned) {
    BodyVertex center = vertices[ring.vertices[0]];
    center.fair = false;
    Vec3 sum(0);
    Vec3 color(0);
    float along = 0;
    for (const std::uint32_t v : ring.vertices) {
        sum += vertices[v].position;
        color += vertices[v].color;
        along += vertices[v].along;
    }
    const auto count = static_cast<float>(ring.vertices.size());
    center.position = sum / count + offset;
    center.color = color / count;
    center.along = along / count;
    if (!ring.closed) {
        center.position.x = 0;
    }
    const std::uint32_t c = add(center);
    const std::size_t columns = ring.closed ? ring.vertices.size() : ring.vertices.size() - 1;
    for (std::size_t j = 0; j < columns; ++j) {
        const float u = width * static_cast<float>(j);
        const Vec2 middle(u + 0.5f * width, ring.v + (turned ? 1.0f : -1.0f) * 0.02f);
        const std::uint32_t a = ring.vertices[j];
        const std::uint32_t b = ring.vertices[(j + 1) % ring.vertices.size()];
        if (turned) {
            add_quad(
                {a, c, b, b},
                {Vec2(u, ring.v), middle, Vec2(u + width, ring.v), Vec2(u + width, ring.v)});
        } else {
            add_quad(
                {b, c, a, a}, {Vec2(u + width, ring.v), middle, Vec2(u, ring.v), Vec2(u, ring.v)});
        }
    }
    return c;
}

void BodyMesh::fair(int rounds) {
    std::vector<std::vector<std::uint32_t>> neighbors(vertices.size());
    for (const BodyQuad& quad : quads) {
        for (int k = 0; k < 4; ++k) {
            const std::uint32_t a = quad.corners[k];
            const std::uint32_t b = quad.corners[(k + 1) % 4];
            if (a != b && vertices[a].fair) {
                neighbors[a].push_back(b);
            }
            if (a != b && vertices[b].fair) {
                neighbors[b].push_back(a);
            }
        }
    }
    std::vector<Vec3> moved(vertices.size());
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            moved[i] = vertices[i].position;
            if (!neighbors[i].empty()) {
                Vec3 sum(0);
                for (const std::uint32_t n : neighbors[i]) {
                    sum += vertices[n].position;
                }
                const Vec3 mean = sum / static_cast<float>(neighbors[i].size());
                moved[i] = glm::mix(moved[i], mean, 0.5f);
            }
        }
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            vertices[i].position = moved[i];
        }
    }
}

void BodyMesh::mirror() {
    const std::size_t count = vertices.size();
    std::vector<std::uint32_t> image(count);
    for (std::size_t i = 0; i < count; ++i) {
        BodyVertex copy = vertices[i];
        if (copy.position.x == 0.0f) {
            image[i] = static_cast<std::uint32_t>(i);
            continue;
        }
        copy.position.x = -copy.position.x;
        copy.side = static_cast<std::int8_t>(-copy.side);
        copy.lift.x = -copy.lift.x;
        image[i] = add(copy);
    }
    const std::size_t quad_count = quads.size();
    for (std::size_t i = 0; i < quad_count; ++i) {
        BodyQuad copy = quads[i];
        const int corners = copy.corners[2] == copy.corners[3] ? 3 : 4;
        std::reverse(copy.corners.begin(), copy.corners.begin() + corners);
        std::reverse(copy.uvs.begin(), copy.uvs.begin() + corners);
        for (int k = 0; k < corners; ++k) {
            copy.corners[k] = image[copy.corners[k]];
            copy.uvs[k].x = -copy.uvs[k].x;
        }
        if (corners == 3) {
            copy.corners[3] = copy.corners[2];
            copy.uvs[3] = copy.uvs[2];
        }
        quads.push_back(copy);
    }
}

namespace {

/// The smallest vertex of the shell that each vertex belongs to.
std::vector<std::uint32_t> find_shells(const BodyMesh& mesh) {
    std::vector<std::uint32_t> root(mesh.vertices.size());
    std::iota(root.begin(), root.end(), 0u);
    const auto find = [&](std::uint32_t v) {
        while (root[v] != v) {
            root[v] = root[root[v]];
            v = root[v];
        }
        return v;
    };
    for (const BodyQuad& quad : mesh.quads) {
        for (int k = 1; k < 4; ++k) {
            const std::uint32_t a = find(quad.corners[0]);
            const std::uint32_t b = find(quad.corners[k]);
            root[std::max(a, b)] = std::min(a, b);
        }
    }
    for (std::uint32_t v = 0; v < root.size(); ++v) {
        root[v] = find(v);
    }
    return root;
}

template <typename Visit>
void for_each_triangle(
    const BodyQuad& quad, const std::vector<BodyVertex>& vertices, Visit&& visit) {
    if (quad.corners[2] == quad.corners[3]) {
        visit(0, 1, 2);
        return;
    }
    const auto length = [&](int a, int b) {
        return glm::distance(
            vertices[quad.corners[a]].position, vertices[quad.corners[b]].position);
    };
    if (length(0, 2) <= length(1, 3)) {
        visit(0, 1, 2);
        visit(0, 2, 3);
    } else {
        visit(1, 2, 3);
        visit(1, 3, 0);
    }
}

}  // namespace

void BodyMesh::face_outwards() {
    const std::vector<std::uint32_t> shell = find_shells(*this);
    std::vector<double> volume(vertices.size(), 0.0);
    std::vector<double> chart(vertices.size(), 0.0);
    for (const BodyQuad& quad : quads) {
        for_each_triangle(quad, vertices, [&](int a, int b, int c) {
            const Vec3 p = vertices[quad.corners[a]].position;
            const Vec3 q = vertices[quad.corners[b]].position;
            const Vec3 r = vertices[quad.corners[c]].position;
            volume[shell[quad.corners[0]]] += static_cast<double>(glm::dot(p, glm::cross(q, r)));
            const Vec2 d1 = quad.uvs[b] - quad.uvs[a];
            const Vec2 d2 = quad.uvs[c] - quad.uvs[a];
            chart[shell[quad.corners[0]]] += static_cast<double>(d1.x * d2.y - d1.y * d2.x);
        });
    }
    for (BodyQuad& quad : quads) {
        const std::uint32_t own = shell[quad.corners[0]];
        const bool turned = volume[own] < 0;
        // Triangles that face outwards have clockwise texture coordinates, v down.
        if ((chart[own] > 0) != turned) {
            for (Vec2& uv : quad.uvs) {
                uv.x = -uv.x;
            }
        }
        if (turned) {
            const int corners = quad.corners[2] == quad.corners[3] ? 3 : 4;
            std::reverse(quad.corners.begin(), quad.corners.begin() + corners);
            std::reverse(quad.uvs.begin(), quad.uvs.begin() + corners);
            if (corners == 3) {
                quad.corners[3] = quad.corners[2];
                quad.uvs[3] = quad.uvs[2];
            }
        }
    }
}

MeshData BodyMesh::finish(const PersonFrame& frame, float crease) const {
    MeshData mesh;
    std::vector<std::uint32_t> source;
    std::map<std::tuple<std::uint32_t, float, float>, std::uint32_t> made;
    for (const BodyQuad& quad : quads) {
        std::array<std::uint32_t, 4> corners{};
        for (int k = 0; k < 4; ++k) {
            const Vec2 uv = quad.uvs[k];
            const auto [found, added] = made.try_emplace(
                {quad.corners[k], uv.x, uv.y}, static_cast<std::uint32_t>(source.size()));
            if (added) {
                source.push_back(quad.corners[k]);
                mesh.positions.push_back(vertices[quad.corners[k]].position);
                mesh.uvs.push_back(uv);
                mesh.colors.emplace_back(vertices[quad.corners[k]].color, 1.0f);
            }
            corners[k] = found->second;
        }
        for_each_triangle(quad, vertices, [&](int a, int b, int c) {
            mesh.indices.insert(mesh.indices.end(), {corners[a], corners[b], corners[c]});
        });
    }
    const std::vector<JointWeights> weights = person_weights(frame, *this);
    for (const std::uint32_t v : source) {
        append_weights(mesh.skin, weights[v]);
    }
    mesh.skin.first.push_back(static_cast<std::uint32_t>(mesh.skin.joints.size()));
    generate_normals(mesh, crease);
    generate_tangents(mesh);
    update_bounds(mesh);
    return mesh;
}

void thin_out(MeshData& mesh, const PersonFrame& frame, float error, float crease) {
    if (frame.look.shape.triangles > 0) {
        return;
    }
    constexpr float kSpread = 0.06f;  // of what different joints move [m]
    constexpr float kTint = 0.003f;   // of what has different colors [m]
    std::vector<Vec3> warped = mesh.positions;
    for (std::size_t v = 0; v < warped.size(); ++v) {
        for (std::uint32_t i = mesh.skin.first[v]; i < mesh.skin.first[v + 1]; ++i) {
            const float turn = 2.4f * static_cast<float>(mesh.skin.joints[i]);
            const Vec3 way(std::cos(turn), std::sin(1.7f * turn), std::sin(turn));
            warped[v] += kSpread * mesh.skin.weights[i] * way;
        }
        warped[v] += kTint * Vec3(mesh.colors[v]);
    }
    const float scale = meshopt_simplifyScale(&warped[0].x, warped.size(), sizeof(Vec3));
    std::vector<std::uint32_t> indices(mesh.indices.size());
    indices.resize(meshopt_simplify(
        indices.data(), mesh.indices.data(), mesh.indices.size(), &warped[0].x, warped.size(),
        sizeof(Vec3), 0, error / scale));
    keep_triangles(mesh, std::move(indices));
    generate_normals(mesh, crease);
    generate_tangents(mesh);
}

void append_part(MeshData& mesh, const MeshData& part) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto append = [](auto& to, const auto& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    append(mesh.positions, part.positions);
    append(mesh.normals, part.normals);
    append(mesh.tangents, part.tangents);
    append(mesh.uvs, part.uvs);
    append(mesh.colors, part.colors);
    for (const std::uint32_t index : part.indices) {
        mesh.indices.push_back(first + index);
    }
    if (!mesh.skin.first.empty()) {
        mesh.skin.first.pop_back();
    }
    const auto base = static_cast<std::uint32_t>(mesh.skin.joints.size());
    for (const std::uint32_t begin : part.skin.first) {
        mesh.skin.first.push_back(base + begin);
    }
    append(mesh.skin.joints, part.skin.joints);
    append(mesh.skin.weights, part.skin.weights);
    mesh.morphs.resize(std::max(mesh.morphs.size(), part.morphs.size()));
    for (std::size_t t = 0; t < part.morphs.size(); ++t) {
        MorphTarget& target = mesh.morphs[t];
        const MorphTarget& more = part.morphs[t];
        target.name = more.name;
        target.action_unit = more.action_unit;
        for (const std::uint32_t v : more.vertices) {
            target.vertices.push_back(first + v);
        }
        append(target.positions, more.positions);
        append(target.normals, more.normals);
    }
    grow(mesh.bounds, part.bounds);
}

}  // namespace limn
