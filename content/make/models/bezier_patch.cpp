#include "content/make/models/bezier_patch.h"

#include "ecs/base/check.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

// Techniques: anim.bezier-eval, anim.bezier-patch, anim.bezier-patch-frame, anim.bezier-patch-lod,
//     anim.bezier-patch-tessellate, bump.tangent-bezier

namespace limn {

namespace {

using Curve = std::array<Vec3, 4>;

/// The patch with v fixed: a cubic in u.
template <typename Along>
Curve collapse_v(const BezierPatch& patch, Along&& along) {
    return {along(patch.p[0]), along(patch.p[1]), along(patch.p[2]), along(patch.p[3])};
}

void split_curve(const Curve& p, Curve& low, Curve& high) {
    const Vec3 a = 0.5f * (p[0] + p[1]);
    const Vec3 b = 0.5f * (p[1] + p[2]);
    const Vec3 c = 0.5f * (p[2] + p[3]);
    const Vec3 ab = 0.5f * (a + b);
    const Vec3 bc = 0.5f * (b + c);
    const Vec3 midpoint = 0.5f * (ab + bc);
    low = {p[0], a, ab, midpoint};
    high = {midpoint, bc, c, p[3]};
}

}  // namespace

Vec3 patch_point(const BezierPatch& patch, float u, float v) {
    return bezier_point(collapse_v(patch, [v](const Curve& c) { return bezier_point(c, v); }), u);
}

Vec3 patch_du(const BezierPatch& patch, float u, float v) {
    return bezier_derivative(
        collapse_v(patch, [v](const Curve& c) { return bezier_point(c, v); }), u);
}

Vec3 patch_dv(const BezierPatch& patch, float u, float v) {
    return bezier_point(
        collapse_v(patch, [v](const Curve& c) { return bezier_derivative(c, v); }), u);
}

Vec3 patch_duv(const BezierPatch& patch, float u, float v) {
    return bezier_derivative(
        collapse_v(patch, [v](const Curve& c) { return bezier_derivative(c, v); }), u);
}

PatchFrame patch_frame(const BezierPatch& patch, float u, float v) {
    PatchFrame frame;
    frame.point = patch_point(patch, u, v);
    Vec3 du = patch_du(patch, u, v);
    Vec3 dv = patch_dv(patch, u, v);

    // The tangent plane is degenerate if the sine of the angle between the two, or their lengths
    // relative to the patch, are too small. If so, step toward the center of the patch.
    Bounds box;
    for (const Curve& row : patch.p) {
        for (const Vec3& point : row) {
            grow(box, point);
        }
    }
    const float size = glm::length(box.max - box.min);
    float inner_u = u;
    float inner_v = v;
    for (int step = 0; step < 8; ++step) {
        const Vec3 cross = glm::cross(du, dv);
        const float lengths = glm::length(du) * glm::length(dv);
        if (lengths > 1e-6f * size * size && glm::length(cross) > 1e-3f * lengths) {
            break;
        }
        const float step_fraction = step == 0 ? 1e-3f : 0.25f;
        inner_u += step_fraction * (0.5f - inner_u);
        inner_v += step_fraction * (0.5f - inner_v);
        du = patch_du(patch, inner_u, inner_v);
        dv = patch_dv(patch, inner_u, inner_v);
    }

    frame.normal = normalize_or(glm::cross(du, dv), {0, 0, 1});
    const Vec3 along = du - frame.normal * glm::dot(frame.normal, du);
    frame.tangent = normalize_or(along, any_perpendicular(frame.normal));
    return frame;
}

std::array<BezierPatch, 4> split_patch(const BezierPatch& patch) {
    // First along v inside each row, then along u across the rows.
    BezierPatch half[2];
    for (std::size_t i = 0; i < 4; ++i) {
        split_curve(patch.p[i], half[0].p[i], half[1].p[i]);
    }
    std::array<BezierPatch, 4> children;
    for (std::size_t side = 0; side < 2; ++side) {
        for (std::size_t j = 0; j < 4; ++j) {
            Curve low;
            Curve high;
            split_curve(
                {half[side].p[0][j], half[side].p[1][j], half[side].p[2][j], half[side].p[3][j]},
                low, high);
            for (std::size_t i = 0; i < 4; ++i) {
                children[2 * side].p[i][j] = low[i];
                children[2 * side + 1].p[i][j] = high[i];
            }
        }
    }
    return children;
}

float patch_flatness(const BezierPatch& patch) {
    float worst = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            const float u = static_cast<float>(i) / 3.0f;
            const float v = static_cast<float>(j) / 3.0f;
            const Vec3 low = glm::mix(patch.p[0][0], patch.p[3][0], u);
            const Vec3 high = glm::mix(patch.p[0][3], patch.p[3][3], u);
            worst = std::max(worst, glm::length(patch.p[i][j] - glm::mix(low, high, v)));
        }
    }
    return worst;
}

PatchTriangles tessellate_uniform(std::size_t patch_count, int divisions) {
    LIMN_CHECK(divisions >= 1);
    const std::uint32_t row = static_cast<std::uint32_t>(divisions) + 1;
    PatchTriangles out;
    out.samples.reserve(patch_count * row * row);
    out.indices.reserve(patch_count * 6 * (row - 1) * (row - 1));
    for (std::uint32_t patch = 0; patch < patch_count; ++patch) {
        const std::uint32_t first = patch * row * row;
        for (std::uint32_t j = 0; j < row; ++j) {
            for (std::uint32_t i = 0; i < row; ++i) {
                out.samples.push_back(
                    {patch, static_cast<float>(i) / static_cast<float>(divisions),
                     static_cast<float>(j) / static_cast<float>(divisions)});
            }
        }
        for (std::uint32_t j = 0; j + 1 < row; ++j) {
            for (std::uint32_t i = 0; i + 1 < row; ++i) {
                const std::uint32_t a = first + j * row + i;
                for (const std::uint32_t index : {a, a + 1, a + 1 + row, a, a + 1 + row, a + row}) {
                    out.indices.push_back(index);
                }
            }
        }
    }
    return out;
}

// ---- adaptive ----------------------------------------------------------------------------------

namespace {

/// A square of the parameter plane: corner and side in steps of the finest grid, which is one level
/// finer than the smallest leaf, so that the center of every leaf is on it.
struct Leaf {
    std::uint32_t patch;
    int u;
    int v;
    int side;
};

void find_leaves(const BezierPatch& patch, float tolerance, Leaf leaf, std::vector<Leaf>& leaves) {
    if (leaf.side == 2 || patch_flatness(patch) <= tolerance) {
        leaves.push_back(leaf);
        return;
    }
    const std::array<BezierPatch, 4> children = split_patch(patch);
    const int half = leaf.side / 2;
    for (int child = 0; child < 4; ++child) {
        const Leaf quarter = {
            leaf.patch, leaf.u + (child % 2) * half, leaf.v + (child / 2) * half, half};
        find_leaves(children[static_cast<std::size_t>(child)], tolerance, quarter, leaves);
    }
}

/// A boundary curve, equal for both patches that share it: its 12 numbers in the lexicographically
/// smaller of the two directions.
struct BoundaryKey {
    std::array<float, 12> numbers;
    bool reversed;
};

BoundaryKey boundary_key(const Curve& curve) {
    BoundaryKey forward{{}, false};
    BoundaryKey backward{{}, true};
    for (std::size_t i = 0; i < 4; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            // + 0 turns -0, which mirrored patches have, into 0
            forward.numbers[3 * i + static_cast<std::size_t>(axis)] = curve[i][axis] + 0.0f;
            backward.numbers[3 * i + static_cast<std::size_t>(axis)] = curve[3 - i][axis] + 0.0f;
        }
    }
    return backward.numbers < forward.numbers ? backward : forward;
}

/// The four boundaries of a patch: v = 0, u = 1, v = 1, u = 0, in increasing u or v.
Curve boundary_curve(const BezierPatch& patch, int edge) {
    const auto& p = patch.p;
    switch (edge) {
    case 0:
        return {p[0][0], p[1][0], p[2][0], p[3][0]};
    case 1:
        return {p[3][0], p[3][1], p[3][2], p[3][3]};
    case 2:
        return {p[0][3], p[1][3], p[2][3], p[3][3]};
    default:
        return {p[0][0], p[0][1], p[0][2], p[0][3]};
    }
}

/// Which points of the finest grid are vertices, patch by patch.
class VertexGrid {
  public:
    VertexGrid(std::size_t patches, int steps)
        : row_(static_cast<std::size_t>(steps) + 1), used_(patches * row_ * row_, 0) {}
    [[nodiscard]] char& at(std::uint32_t patch, int u, int v) {
        return used_
            [(patch * row_ + static_cast<std::size_t>(v)) * row_ + static_cast<std::size_t>(u)];
    }

  private:
    std::size_t row_;
    std::vector<char> used_;
};

/// Gives both patches at a boundary the union of their vertices.
void match_boundaries(std::span<const BezierPatch> patches, int steps, VertexGrid& grid) {
    const auto on_edge = [&](std::uint32_t patch, int edge, int t) -> char& {
        switch (edge) {
        case 0:
            return grid.at(patch, t, 0);
        case 1:
            return grid.at(patch, steps, t);
        case 2:
            return grid.at(patch, t, steps);
        default:
            return grid.at(patch, 0, t);
        }
    };
    std::map<std::array<float, 12>, std::set<int>> points_of_curve;
    for (int round = 0; round < 2; ++round) {
        for (std::uint32_t patch = 0; patch < patches.size(); ++patch) {
            for (int edge = 0; edge < 4; ++edge) {
                const BoundaryKey key = boundary_key(boundary_curve(patches[patch], edge));
                std::set<int>& points = points_of_curve[key.numbers];
                for (int t = 0; t <= steps; ++t) {
                    const int point = key.reversed ? steps - t : t;
                    if (round == 0 && on_edge(patch, edge, t) != 0) {
                        points.insert(point);
                    } else if (round == 1 && points.contains(point)) {
                        on_edge(patch, edge, t) = 1;
                    }
                }
            }
        }
    }
}

/// The vertices on the outline of a leaf, counter-clockwise from its low corner.
std::vector<IVec2> leaf_outline(const Leaf& leaf, VertexGrid& grid) {
    std::vector<IVec2> outline;
    const IVec2 direction[4] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    IVec2 point = {leaf.u, leaf.v};
    for (const IVec2& along : direction) {
        for (int step = 0; step < leaf.side; ++step) {
            if (grid.at(leaf.patch, point.x, point.y) != 0) {
                outline.push_back(point);
            }
            point += along;
        }
    }
    return outline;
}

}  // namespace

PatchTriangles
tessellate_adaptive(std::span<const BezierPatch> patches, float tolerance, int max_depth) {
    LIMN_CHECK(tolerance > 0);
    LIMN_CHECK(max_depth >= 0 && max_depth <= 8);

    const int steps = 2 << max_depth;
    std::vector<Leaf> leaves;
    for (std::uint32_t patch = 0; patch < patches.size(); ++patch) {
        find_leaves(patches[patch], tolerance, {patch, 0, 0, steps}, leaves);
    }

    VertexGrid grid(patches.size(), steps);
    for (const Leaf& leaf : leaves) {
        for (int corner = 0; corner < 4; ++corner) {
            grid.at(
                leaf.patch, leaf.u + (corner % 2) * leaf.side, leaf.v + (corner / 2) * leaf.side) =
                1;
        }
    }
    match_boundaries(patches, steps, grid);

    PatchTriangles out;
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> numbered;
    const auto vertex = [&](std::uint32_t patch, const IVec2& point) {
        const auto [entry, fresh] = numbered.try_emplace(
            {patch, static_cast<std::uint32_t>(point.x), static_cast<std::uint32_t>(point.y)},
            static_cast<std::uint32_t>(out.samples.size()));
        if (fresh) {
            const Vec2 uv = Vec2(point) / static_cast<float>(steps);
            out.samples.push_back({patch, uv.x, uv.y});
        }
        return entry->second;
    };
    for (const Leaf& leaf : leaves) {
        const std::vector<IVec2> outline = leaf_outline(leaf, grid);
        std::vector<std::uint32_t> ring;
        for (const IVec2& point : outline) {
            ring.push_back(vertex(leaf.patch, point));
        }
        if (ring.size() == 4) {
            for (const std::size_t corner : {0, 1, 2, 0, 2, 3}) {
                out.indices.push_back(ring[corner]);
            }
            continue;
        }
        const std::uint32_t center =
            vertex(leaf.patch, {leaf.u + leaf.side / 2, leaf.v + leaf.side / 2});
        for (std::size_t i = 0; i < ring.size(); ++i) {
            out.indices.insert(out.indices.end(), {center, ring[i], ring[(i + 1) % ring.size()]});
        }
    }
    return out;
}

// ---- meshes and levels -------------------------------------------------------------------------

MeshData make_patch_mesh(std::span<const BezierPatch> patches, const PatchTriangles& triangles) {
    MeshData mesh;
    const std::size_t count = triangles.samples.size();
    mesh.positions.reserve(count);
    mesh.normals.reserve(count);
    mesh.tangents.reserve(count);
    mesh.uvs.reserve(count);
    for (const PatchSample& sample : triangles.samples) {
        LIMN_CHECK(sample.patch < patches.size());
        const PatchFrame frame = patch_frame(patches[sample.patch], sample.u, sample.v);
        mesh.positions.push_back(frame.point);
        mesh.normals.push_back(frame.normal);
        mesh.tangents.push_back(Vec4(frame.tangent, 1.0f));
        mesh.uvs.push_back({sample.u, 1.0f - sample.v});
        grow(mesh.bounds, frame.point);
    }
    mesh.indices = triangles.indices;
    return mesh;
}

PatchLevels make_patch_levels(const BezierPatch& patch, int count) {
    LIMN_CHECK(count >= 1 && count <= 8);
    PatchLevels levels;
    levels.level.push_back({patch});
    for (int l = 1; l < count; ++l) {
        const std::size_t side = std::size_t{1} << (l - 1);
        const std::vector<BezierPatch>& coarse = levels.level.back();
        std::vector<BezierPatch> fine(4 * side * side);
        for (std::size_t row = 0; row < side; ++row) {
            for (std::size_t column = 0; column < side; ++column) {
                const std::array<BezierPatch, 4> children =
                    split_patch(coarse[row * side + column]);
                for (std::size_t child = 0; child < 4; ++child) {
                    fine[(2 * row + child / 2) * 2 * side + 2 * column + child % 2] =
                        children[child];
                }
            }
        }
        levels.level.push_back(std::move(fine));
    }
    return levels;
}

}  // namespace limn
