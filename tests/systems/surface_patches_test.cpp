#include "ecs/base/rng.h"
#include "systems/animation/patch_binding.h"
#include "systems/animation/patch_kernels.h"
#include "systems/animation/surface_patches.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace limn::surface_patches_test {
namespace {

using test::near;

struct Surface {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> corners;
    std::vector<Vec4> patches;

    void update() { make_patches(positions, corners, patches); }
    [[nodiscard]] std::span<const Vec4> patch(std::size_t f) const {
        return std::span(patches).subspan(f * kPatchTexels, kPatchTexels);
    }
    [[nodiscard]] std::size_t faces() const { return corners.size() / 3; }
};

/// Its first face is the octant (1, 0, 0) (0, 1, 0) (0, 0, 1).
Surface make_octahedron() {
    Surface surface;
    surface.positions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    surface.corners = {0, 1, 2, 1, 3, 2, 3, 4, 2, 4, 0, 2, 1, 0, 5, 3, 1, 5, 4, 3, 5, 0, 4, 5};
    surface.update();
    return surface;
}

/// A bumpy sheet of 2 x 2 m, facing +y.
Surface make_bumpy(int n = 5) {
    Surface surface;
    for (int z = 0; z <= n; ++z) {
        for (int x = 0; x <= n; ++x) {
            const Vec2 at = 2.0f * Vec2(x, z) / static_cast<float>(n) - 1.0f;
            surface.positions.emplace_back(
                at.x, 0.15f * std::sin(3 * at.x) + 0.1f * std::cos(4 * at.y + at.x), at.y);
        }
    }
    const auto at = [n](int x, int z) { return static_cast<std::uint32_t>(z * (n + 1) + x); };
    for (int z = 0; z < n; ++z) {
        for (int x = 0; x < n; ++x) {
            for (const std::uint32_t v :
                 {at(x, z), at(x, z + 1), at(x + 1, z), at(x + 1, z), at(x, z + 1),
                  at(x + 1, z + 1)}) {
                surface.corners.push_back(v);
            }
        }
    }
    surface.update();
    return surface;
}

/// Vertices over a surface, bound to it.
struct Skin {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;
    std::vector<Vec4> tangents;
    std::vector<SurfaceAnchor> anchors;

    void bind(const Surface& surface, float max_distance) {
        normals.assign(positions.size(), glm::normalize(Vec3(0.2f, 1, -0.1f)));
        tangents.assign(positions.size(), Vec4(1, 0, 0, -1));
        anchors = bind_to_patches(
            {positions, normals, tangents}, surface.positions, surface.corners, max_distance);
    }
    [[nodiscard]] Skin follow(const Surface& surface) const {
        Skin moved = *this;
        follow_patches(anchors, surface.patches, moved.positions, moved.normals, moved.tangents);
        return moved;
    }
};

Skin skin_over(const Surface& surface, float max_distance = 0.3f) {
    Skin skin;
    Random random(2, 7, 1, 8);
    while (skin.positions.size() < 400) {
        const Vec2 at = 1.9f * Vec2(random.uniform() - 0.5f, random.uniform() - 0.5f);
        skin.positions.emplace_back(
            at.x,
            0.15f * std::sin(3 * at.x) + 0.1f * std::cos(4 * at.y + at.x)
                + 0.2f * (random.uniform() - 0.5f),
            at.y);
    }
    skin.bind(surface, max_distance);
    return skin;
}

const Affine kTurn =
    affine_from({0.4f, -0.3f, 0.7f}, glm::normalize(Quat(0.6f, 0.3f, -0.5f, 0.4f)), Vec3(1));

Surface map_surface(Surface surface, const auto& map) {
    for (Vec3& p : surface.positions) {
        p = map(p);
    }
    surface.update();
    return surface;
}

Vec3 bend(const Vec3& p) {
    return p + Vec3(0.05f * p.y, 0.2f * std::sin(2 * p.x + p.z), -0.1f * p.x * p.x);
}

}  // namespace

TEST_CASE(
    "patches: over an octant the patch has the control points of a PN triangle, and its edges"
    * technique("face.bids-surface")) {
    const Surface sphere = make_octahedron();
    const std::span<const Vec4> octant = sphere.patch(0);
    CHECK(glm::distance(Vec3(octant[3]), Vec3(1, 1.0f / 3, 0)) < 1e-6f);
    CHECK(glm::distance(Vec3(octant[9]), Vec3(0.5f)) < 1e-6f);
    const PatchPoint center = evaluate_patch(octant, 1.0f / 3, 1.0f / 3);
    // By hand: the points of a quartic with the inner ones (1, 7, 7) / 24 and so on, 38 / 81 each;
    // that of the PN triangle alone is 0.769800.
    CHECK(glm::length(center.position) == near(38 * std::sqrt(3.0) / 81));
    CHECK(glm::distance(Vec3(octant[10]), Vec3(0.25f, 0, -1.0f / 12)) < 1e-6f);
    CHECK(glm::length(evaluate_patch(octant, 0.5f, 0.5f).position) == near(0.883883));
    CHECK(glm::distance(center.normal, glm::normalize(Vec3(1))) < 1e-6f);
}

TEST_CASE(
    "patches: the surface passes through its markers, with their normals"
    * technique("face.bids-surface")) {
    const Surface surface = make_bumpy();
    std::vector<Vec3> normals(surface.positions.size(), Vec3(0));
    for (std::size_t i = 0; i < surface.corners.size(); ++i) {
        const auto corner = [&](std::size_t k) {
            return surface.positions[surface.corners[i / 3 * 3 + k]];
        };
        normals[surface.corners[i]] += glm::cross(corner(1) - corner(0), corner(2) - corner(0));
    }
    for (std::size_t f = 0; f < surface.faces(); ++f) {
        const std::array<Vec2, 3> at = {Vec2(1, 0), Vec2(0, 1), Vec2(0, 0)};
        for (std::size_t k = 0; k < 3; ++k) {
            const PatchPoint corner = evaluate_patch(surface.patch(f), at[k].x, at[k].y);
            CHECK(
                glm::distance(corner.position, surface.positions[surface.corners[3 * f + k]])
                < 1e-6f);
            CHECK(glm::length(corner.normal) == near(1));
            CHECK(
                glm::distance(corner.normal, glm::normalize(normals[surface.corners[3 * f + k]]))
                < 1e-5f);
        }
    }
}

TEST_CASE("patches: markers in a plane make a plane" * technique("face.bids-surface")) {
    Surface flat = make_bumpy();
    for (Vec3& p : flat.positions) {
        p.y = 0.25f * p.x;
    }
    flat.update();
    for (std::size_t f = 0; f < flat.faces(); ++f) {
        for (const Vec2 at : {Vec2(0.2f, 0.3f), Vec2(0.6f, 0.1f), Vec2(0.1f, 0.8f)}) {
            const PatchPoint on = evaluate_patch(flat.patch(f), at.x, at.y);
            CHECK(std::abs(on.position.y - 0.25f * on.position.x) < 1e-6f);
            CHECK(glm::distance(on.normal, glm::normalize(Vec3(-0.25f, 1, 0))) < 1e-6f);
        }
    }
}

/// Calls `visit` with the points of both patches at places along every edge inside.
std::size_t visit_edges(const Surface& surface, const auto& visit) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> first;
    for (std::size_t i = 0; i < surface.corners.size(); ++i) {
        first[{surface.corners[i], surface.corners[i % 3 == 2 ? i - 2 : i + 1]}] = i;
    }
    std::size_t edges = 0;
    for (const auto& [ends, i] : first) {
        const auto other = first.find({ends.second, ends.first});
        if (ends.first > ends.second || other == first.end()) {
            continue;
        }
        ++edges;
        for (int k = 0; k <= 32; ++k) {
            const float t = static_cast<float>(k) / 32.0f;
            const auto at = [&](std::size_t corner, float share) {
                Vec3 weights(0);
                weights[static_cast<int>(corner % 3)] = 1.0f - share;
                weights[static_cast<int>((corner + 1) % 3)] = share;
                return evaluate_patch(surface.patch(corner / 3), weights.x, weights.y);
            };
            visit(at(i, t), at(other->second, 1.0f - t));
        }
    }
    return edges;
}

/// Angle [degrees] between the planes of the derivatives by u and v.
float crease_deg(const PatchPoint& a, const PatchPoint& b) {
    const Vec3 n = glm::normalize(glm::cross(a.by_u, a.by_v));
    const Vec3 m = glm::normalize(glm::cross(b.by_u, b.by_v));
    return glm::degrees(std::atan2(glm::length(glm::cross(n, m)), glm::dot(n, m)));
}

/// The sheet with vertices at random, so that its triangles are slim and of all sizes.
Surface make_uneven(std::uint32_t seed, float height) {
    Surface surface = make_bumpy(7);
    Random random(seed, 3, 3, 3);
    for (Vec3& p : surface.positions) {
        p += 0.16f * Vec3(random.uniform() - 0.5f, 0, random.uniform() - 0.5f);
        p.y = height * p.y + 0.05f * random.uniform();
    }
    surface.update();
    return surface;
}

TEST_CASE(
    "patches: neighbors agree along their edge, in positions and normals"
    * technique("face.bids-surface")) {
    const std::size_t edges =
        visit_edges(make_bumpy(), [](const PatchPoint& a, const PatchPoint& b) {
            CHECK(glm::distance(a.position, b.position) < 1e-6f);
            CHECK(glm::distance(a.normal, b.normal) < 1e-6f);
        });
    CHECK(edges == 65);
}

TEST_CASE(
    "patches: the surface has no creases: tangent planes on both sides of an edge are the same"
    * technique("face.bids-surface")) {
    std::vector<Surface> surfaces = {make_bumpy(), make_octahedron()};
    for (std::uint32_t seed = 0; seed < 4; ++seed) {
        surfaces.push_back(make_uneven(seed, 1 + 0.5f * static_cast<float>(seed)));
    }
    surfaces.push_back(map_surface(make_uneven(9, 1), bend));
    surfaces.push_back(map_surface(make_uneven(5, 1), [](const Vec3& p) { return 0.05f * p; }));
    for (Surface& surface : surfaces) {
        float largest = 0.0f;
        visit_edges(surface, [&](const PatchPoint& a, const PatchPoint& b) {
            largest = std::max(largest, crease_deg(a, b));
        });
        CHECK(largest <= 0.1f);
    }
    // What bends the patches is needed: without it the PN triangles crease.
    float sum = 0.0f;
    float count = 0.0f;
    Surface cubic = surfaces[5];
    for (std::size_t i = 0; i < cubic.patches.size(); ++i) {
        cubic.patches[i] *= i % kPatchTexels < kPatchPoints ? 1.0f : 0.0f;
    }
    visit_edges(cubic, [&](const PatchPoint& a, const PatchPoint& b) {
        sum += crease_deg(a, b);
        ++count;
    });
    CHECK(sum / count > 4.0f);
}

TEST_CASE(
    "patches: derivatives are those of the surface and of its normals"
    * technique("face.bids-surface")) {
    const Surface surface = make_bumpy();
    constexpr float kStep = 1e-2f;
    for (std::size_t f = 0; f < surface.faces(); f += 7) {
        const auto at = [&](float u, float v) { return evaluate_patch(surface.patch(f), u, v); };
        const PatchPoint p = at(0.3f, 0.4f);
        const auto check = [&](const PatchPoint& more, const PatchPoint& less, const Vec3& by,
                               const Vec3& normal_by) {
            const Vec3 slope = (more.position - less.position) / (2 * kStep);
            const Vec3 turn = (more.normal - less.normal) / (2 * kStep);
            CHECK(glm::distance(slope, by) < 1e-3f);
            CHECK(glm::distance(turn, normal_by) < 1e-3f);
        };
        check(at(0.3f + kStep, 0.4f), at(0.3f - kStep, 0.4f), p.by_u, p.normal_by_u);
        check(at(0.3f, 0.4f + kStep), at(0.3f, 0.4f - kStep), p.by_v, p.normal_by_v);
    }
}

TEST_CASE(
    "patches: markers at rest leave a mesh at rest"
    * technique("face.bids-project, face.bids-rebuild")) {
    const Surface surface = make_bumpy();
    const Skin skin = skin_over(surface);
    const Skin moved = skin.follow(surface);
    std::size_t bound = 0;
    for (std::size_t i = 0; i < skin.positions.size(); ++i) {
        bound += skin.anchors[i].patch != kNoPatch ? 1 : 0;
        CHECK(glm::distance(moved.positions[i], skin.positions[i]) < 1e-6f);
        CHECK(glm::distance(moved.normals[i], skin.normals[i]) < 1e-5f);
        CHECK(glm::distance(moved.tangents[i], skin.tangents[i]) < 1e-5f);
    }
    CHECK(bound > 390);
}

TEST_CASE(
    "patches: the offset of a vertex is its distance along the normal, outside positive"
    * technique("face.bids-project")) {
    const Surface surface = make_bumpy();
    Skin skin;
    std::vector<float> heights;
    std::vector<Vec3> feet;
    for (std::size_t f = 0; f < surface.faces(); f += 3) {
        for (const float height : {-0.05f, 0.0f, 0.02f, 0.1f}) {
            const PatchPoint on = evaluate_patch(surface.patch(f), 0.35f, 0.4f);
            skin.positions.push_back(on.position + height * on.normal);
            heights.push_back(height);
            feet.push_back(on.position);
        }
    }
    skin.bind(surface, 1);
    for (std::size_t i = 0; i < heights.size(); ++i) {
        const SurfaceAnchor& anchor = skin.anchors[i];
        REQUIRE(anchor.patch != kNoPatch);
        CHECK(glm::length(anchor.offset - Vec3(0, 0, heights[i])) < 1e-5f);
        CHECK(
            glm::distance(
                evaluate_patch(surface.patch(anchor.patch), anchor.u, anchor.v).position, feet[i])
            < 1e-4f);
    }
}

TEST_CASE(
    "patches: a vertex is bound to the nearest point of the whole surface"
    * technique("face.bids-project")) {
    const Surface surface = make_bumpy();
    const Skin skin = skin_over(surface);
    std::vector<Vec3> samples;
    for (std::size_t f = 0; f < surface.faces(); ++f) {
        for (int i = 0; i <= 20; ++i) {
            for (int j = 0; i + j <= 20; ++j) {
                samples.push_back(
                    evaluate_patch(
                        surface.patch(f), static_cast<float>(i) / 20, static_cast<float>(j) / 20)
                        .position);
            }
        }
    }
    REQUIRE(samples.size() > 10000);
    for (std::size_t i = 0; i < skin.positions.size(); i += 5) {
        float nearest = INFINITY;
        for (const Vec3& sample : samples) {
            nearest = std::min(nearest, glm::distance(sample, skin.positions[i]));
        }
        // Along the field of normals, which leans a little: not quite the nearest point.
        if (skin.anchors[i].patch != kNoPatch) {
            CHECK(glm::length(skin.anchors[i].offset) < 1.03f * nearest + 1e-3f);
        }
    }
}

TEST_CASE(
    "patches: a rigid motion of the markers moves the mesh rigidly"
    * technique("face.bids-rebuild")) {
    const Surface surface = make_bumpy();
    const Skin skin = skin_over(surface);
    const Skin moved =
        skin.follow(map_surface(surface, [](const Vec3& p) { return transform_point(kTurn, p); }));
    for (std::size_t i = 0; i < skin.positions.size(); ++i) {
        if (skin.anchors[i].patch == kNoPatch) {
            continue;
        }
        CHECK(glm::distance(moved.positions[i], transform_point(kTurn, skin.positions[i])) < 1e-5f);
        CHECK(glm::distance(moved.normals[i], transform_vector(kTurn, skin.normals[i])) < 2e-5f);
        CHECK(
            glm::distance(Vec3(moved.tangents[i]), transform_vector(kTurn, Vec3(skin.tangents[i])))
            < 2e-5f);
        CHECK(moved.tangents[i].w == -1.0f);
    }
}

TEST_CASE(
    "patches: vertices on both sides of an edge stay together" * technique("face.bids-rebuild")) {
    const Surface surface = make_bumpy();
    Skin skin;
    for (std::size_t f = 0; f < surface.faces(); f += 2) {  // over the diagonals of the grid
        for (float t = 0.1f; t < 0.95f; t += 0.2f) {
            const PatchPoint on = evaluate_patch(surface.patch(f), 0, t);
            const Vec3 along = glm::normalize(on.by_v);
            const Vec3 across = glm::normalize(glm::cross(along, on.normal));
            skin.positions.push_back(on.position + 0.05f * on.normal + 1e-4f * across);
            skin.positions.push_back(on.position + 0.05f * on.normal - 1e-4f * across);
        }
    }
    skin.bind(surface, 1);
    const Skin moved = skin.follow(map_surface(surface, bend));
    std::size_t apart = 0;
    for (std::size_t i = 0; i < skin.positions.size(); i += 2) {
        REQUIRE(skin.anchors[i].patch != kNoPatch);
        apart += skin.anchors[i].patch != skin.anchors[i + 1].patch ? 1 : 0;
        CHECK(glm::distance(moved.positions[i], moved.positions[i + 1]) < 1e-3f);
    }
    CHECK(apart > skin.positions.size() / 3);
}

TEST_CASE(
    "patches: a vertex rises by as much as its offset grows" * technique("face.bids-rebuild")) {
    const Surface surface = make_bumpy();
    const Surface bent = map_surface(surface, bend);
    Skin skin = skin_over(surface);
    std::vector<Skin> moved;
    for (const float scale : {0.0f, 1.0f, 2.0f}) {
        Skin scaled = skin;
        for (SurfaceAnchor& anchor : scaled.anchors) {
            anchor.offset *= scale;
        }
        moved.push_back(scaled.follow(bent));
    }
    for (std::size_t i = 0; i < skin.positions.size(); ++i) {
        if (skin.anchors[i].patch != kNoPatch) {
            const Vec3 mean = 0.5f * (moved[0].positions[i] + moved[2].positions[i]);
            CHECK(glm::distance(moved[1].positions[i], mean) < 1e-6f);
        }
    }
}

TEST_CASE(
    "patches: normals and tangents are those of the moved mesh" * technique("face.bids-rebuild")) {
    const Surface surface = make_bumpy();
    const Surface bent = map_surface(surface, bend);
    constexpr float kStep = 2e-3f;
    Skin skin;  // triples: a point and its neighbors along x and z, in a plane
    for (std::size_t f = 0; f < surface.faces(); f += 2) {
        const PatchPoint on = evaluate_patch(surface.patch(f), 0.3f, 0.35f);
        const Vec3 at = on.position + Vec3(0, 0.05f, 0);
        for (const Vec3& by : {Vec3(0), Vec3(kStep, 0, 0), Vec3(0, 0, kStep)}) {
            skin.positions.push_back(at + by);
        }
    }
    skin.bind(surface, 1);
    skin.normals.assign(skin.positions.size(), Vec3(0, 1, 0));
    skin.anchors = bind_to_patches(
        {skin.positions, skin.normals, skin.tangents}, surface.positions, surface.corners, 1);
    const Skin moved = skin.follow(bent);
    for (std::size_t i = 0; i < skin.positions.size(); i += 3) {
        const Vec3 along_x = moved.positions[i + 1] - moved.positions[i];
        const Vec3 along_z = moved.positions[i + 2] - moved.positions[i];
        const Vec3 normal = glm::normalize(glm::cross(along_z, along_x));
        CHECK(glm::distance(moved.normals[i], normal) < 0.02f);
        CHECK(glm::distance(Vec3(moved.tangents[i]), glm::normalize(along_x)) < 0.02f);
    }
}

TEST_CASE(
    "patches: vertices too far from the surface or beside it are not bound"
    * technique("face.bids-project")) {
    const Surface surface = make_bumpy();
    Skin skin;
    skin.positions = {{0, 0.6f, 0}, {0, 0.12f, 0}, {1.3f, 0.1f, 0}, {0.2f, 0.1f, -1.4f}};
    skin.bind(surface, 0.3f);
    CHECK(skin.anchors[0].patch == kNoPatch);
    CHECK(skin.anchors[1].patch != kNoPatch);
    CHECK(skin.anchors[2].patch == kNoPatch);
    CHECK(skin.anchors[3].patch == kNoPatch);
    const Skin moved = skin.follow(map_surface(surface, bend));
    CHECK(moved.positions[0] == skin.positions[0]);
    CHECK(moved.normals[2] == skin.normals[2]);
    CHECK(moved.positions[1] != skin.positions[1]);
}

TEST_CASE(
    "patches: beside the surface the motion fades out, without a jump"
    * technique("face.bids-project, face.mocap-drive")) {
    const Surface surface = make_bumpy();
    const float reach = 0.4f;
    Skin skin;
    for (int i = 0; i <= 400; ++i) {  // outward across the border, at x = 1
        skin.positions.emplace_back(0.8f + 0.002f * static_cast<float>(i), 0.1f, 0.13f);
    }
    skin.bind(surface, reach);
    const Skin moved =
        skin.follow(map_surface(surface, [](const Vec3& p) { return p + Vec3(0, 0.3f, 0); }));
    for (std::size_t i = 0; i < skin.positions.size(); ++i) {
        const float x = skin.positions[i].x;
        const float rise = moved.positions[i].y - skin.positions[i].y;
        const float last = i > 0 ? moved.positions[i - 1].y - skin.positions[i - 1].y : 0.3f;
        CHECK(rise <= last + 1e-6f);
        CHECK(last - rise < 0.01f);  // 4 mm where the slope of the fall-off is greatest
        if (x < 0.95f || x > 1.41f) {
            CHECK(rise == (x < 1 ? near(0.3).epsilon(1e-4) : near(0)));
        }
        CHECK((rise == 0.0f) == (skin.anchors[i].patch == kNoPatch));
    }
    const float halfway = moved.positions[200].y - skin.positions[200].y;  // x = 1.2
    CHECK(halfway > 0.1f);
    CHECK(halfway < 0.2f);
}

/// Largest length of an edge of a ball, relative to that at rest, when the lowest of eight markers
/// on its front moves down by a fifth of the radius.
float largest_stretch_of_jaw() {
    Surface markers;
    markers.positions = {Vec3(0, 0, 1), Vec3(0, 0.6f, 0.8f)};
    for (int i = 0; i < 6; ++i) {
        const float angle = kPi / 3 * static_cast<float>(i) - kPi / 2;
        markers.positions.push_back(
            glm::normalize(Vec3(0.6f * std::cos(angle), 0.6f * std::sin(angle), 0.75f)));
    }
    markers.corners = {0, 2, 3, 0, 3, 4, 0, 4, 1, 1, 4, 5, 0, 1, 6, 1, 5, 6, 0, 6, 7, 0, 7, 2};
    markers.update();
    Skin skin;
    constexpr int kRows = 40;
    for (int row = 0; row <= kRows; ++row) {
        for (int column = 0; column < 2 * kRows; ++column) {
            const float up = kPi * (static_cast<float>(row) / kRows - 0.5f);
            const float around = kPi * static_cast<float>(column) / kRows;
            skin.positions.emplace_back(
                std::cos(up) * std::sin(around), std::sin(up), std::cos(up) * std::cos(around));
        }
    }
    skin.normals = skin.positions;
    skin.tangents.assign(skin.positions.size(), Vec4(1, 0, 0, 1));
    skin.anchors = bind_to_patches(
        {skin.positions, skin.normals, skin.tangents}, markers.positions, markers.corners, 0.8f);
    Surface open = markers;
    open.positions[2].y -= 0.2f;
    open.update();
    const Skin moved = skin.follow(open);
    float largest = 0.0f;
    float fall = 0.0f;
    const auto stretch = [&](std::size_t a, std::size_t b) {
        const float rest = glm::distance(skin.positions[a], skin.positions[b]);
        if (rest > 1e-3f) {
            largest =
                std::max(largest, glm::distance(moved.positions[a], moved.positions[b]) / rest);
        }
    };
    for (std::size_t v = 0; v < skin.positions.size(); ++v) {
        fall = std::max(fall, skin.positions[v].y - moved.positions[v].y);
        if (v + 2 * kRows < skin.positions.size()) {
            stretch(v, v + 2 * kRows);
        }
        stretch(v, v % (2 * kRows) == 2 * kRows - 1 ? v + 1 - 2 * kRows : v + 1);
    }
    CHECK(fall > 0.15f);
    return largest;
}

TEST_CASE(
    "patches: eight markers on the front of a ball do not tear it"
    * technique("face.bids-project, face.mocap-drive")) {
    CHECK(largest_stretch_of_jaw() < 1.6f);
}

TEST_CASE(
    "patches: above a ridge, where no patch is straight below, the mesh is still bound"
    * technique("face.bids-project")) {
    Surface sphere = make_octahedron();
    Skin skin;
    Random random(5, 5, 5, 5);
    for (int i = 0; i < 300; ++i) {
        skin.positions.push_back((0.4f + 0.8f * random.uniform()) * random.direction());
    }
    skin.bind(sphere, 2);
    for (const SurfaceAnchor& anchor : skin.anchors) {
        CHECK(anchor.patch != kNoPatch);
    }
    const Skin moved =
        skin.follow(map_surface(sphere, [](const Vec3& p) { return transform_point(kTurn, p); }));
    for (std::size_t i = 0; i < skin.positions.size(); ++i) {
        CHECK(glm::distance(moved.positions[i], transform_point(kTurn, skin.positions[i])) < 1e-5f);
    }
}

TEST_CASE(
    "patches: of two touching surfaces, each moves the points that face the same direction"
    * technique("face.bids-project")) {
    Surface lips = make_bumpy();
    const std::size_t lower = lips.faces();
    const auto count = static_cast<std::uint32_t>(lips.positions.size());
    for (std::uint32_t v = 0; v < count; ++v) {
        lips.positions.push_back(lips.positions[v] + Vec3(0, 0.01f, 0));
    }
    for (std::size_t i = 0; i < 3 * lower; i += 3) {
        for (const std::size_t k : {std::size_t{0}, std::size_t{2}, std::size_t{1}}) {
            lips.corners.push_back(lips.corners[i + k] + count);
        }
    }
    lips.update();
    std::vector<Vec3> points;
    std::vector<Vec3> normals;
    for (std::size_t f = 0; f < lower; f += 2) {
        const Vec3 on = evaluate_patch(lips.patch(f), 0.3f, 0.4f).position;
        points.insert(points.end(), {on + Vec3(0, 0.002f, 0), on + Vec3(0, 0.008f, 0)});
        points.insert(points.end(), {on + Vec3(0, 0.008f, 0), on + Vec3(0, 0.002f, 0)});
        normals.insert(normals.end(), {{0, 1, 0}, {0, -1, 0}, {0, 1, 0}, {0, -1, 0}});
    }
    const std::vector<Vec4> tangents(points.size(), Vec4(1, 0, 0, 1));
    const std::vector<SurfaceAnchor> anchors =
        bind_to_patches({points, normals, tangents}, lips.positions, lips.corners, 1);
    for (std::size_t i = 0; i < points.size(); ++i) {
        REQUIRE(anchors[i].patch != kNoPatch);
        CHECK((anchors[i].patch < lower) == (normals[i].y > 0));
    }
}

TEST_CASE(
    "patches: with a chart, touching points follow their own side, whatever they face"
    * technique("face.bids-project")) {
    // A sheet and a copy of it that nearly touches and faces the same way: beside it in the chart.
    Surface lips = make_bumpy();
    const std::size_t lower = lips.faces();
    const auto count = static_cast<std::uint32_t>(lips.positions.size());
    std::vector<Vec2> corner_chart;
    for (const std::uint32_t corner : lips.corners) {
        corner_chart.emplace_back(lips.positions[corner].x, lips.positions[corner].z);
    }
    for (std::size_t i = 0; i < 3 * lower; ++i) {
        lips.corners.push_back(lips.corners[i] + count);
        corner_chart.push_back(corner_chart[i] + Vec2(3, 0));
    }
    for (std::uint32_t v = 0; v < count; ++v) {
        lips.positions.push_back(lips.positions[v] + Vec3(0, 1e-3f, 0));
    }
    lips.update();
    Skin skin;
    std::vector<Vec2> chart;
    for (std::size_t f = 0; f < lower; ++f) {
        const Vec3 on = evaluate_patch(lips.patch(f), 0.3f, 0.4f).position;
        skin.positions.insert(skin.positions.end(), {on, on});
        chart.insert(chart.end(), {{on.x, on.z}, {on.x + 3, on.z}});
    }
    const std::vector<Vec3> normals(skin.positions.size(), Vec3(0, 1, 0));
    const std::vector<Vec4> tangents(skin.positions.size(), Vec4(1, 0, 0, 1));
    const std::vector<SurfaceAnchor> anchors = bind_to_patches(
        {skin.positions, normals, tangents}, lips.positions, lips.corners, 1,
        {chart, corner_chart});
    for (std::size_t i = 0; i < anchors.size(); ++i) {
        REQUIRE(anchors[i].patch != kNoPatch);
        CHECK((anchors[i].patch < lower) == (i % 2 == 0));
        CHECK(std::abs(anchors[i].offset.z - (i % 2 == 0 ? 0.0f : -1e-3f)) < 2e-4f);
    }
}

TEST_CASE(
    "patches: SIMD, patch by patch, moves vertices the same as one by one"
    * technique("face.bids-rebuild")) {
    const Surface surface = make_bumpy();
    Skin skin = skin_over(surface);
    skin.positions.emplace_back(0.3f, 1, 0.2f);  // is not bound
    Random random(5, 5, 5, 5);
    for (int i = 0; i < 60; ++i) {  // beside what lies below: offsets along the surface
        skin.positions.push_back(skin.positions[static_cast<std::size_t>(i)]);
    }
    skin.bind(surface, 0.3f);
    for (std::size_t i = skin.anchors.size() - 60; i < skin.anchors.size(); ++i) {
        skin.anchors[i].offset.x = 0.05f * random.uniform();
        skin.anchors[i].offset.y = -0.03f * random.uniform();
    }
    const std::vector<std::uint32_t> order = order_by_patch(skin.anchors);
    CHECK(order.size() + 1 <= skin.anchors.size());
    Surface bent = map_surface(surface, bend);
    for (const bool crushed : {false, true}) {
        if (crushed) {  // the first triangle has neither normals nor tangents
            for (std::size_t k = 0; k < 3; ++k) {
                bent.positions[bent.corners[k]] = Vec3(1, 2, 3);
            }
            bent.update();
            for (std::size_t i = 0; i < kPatchTexels; ++i) {
                bent.patches[i] = Vec4(1, 2, 3, 0) * (i < kPatchPoints ? 1.0f : 0.0f);
            }
        }
        const SurfaceShape shape = {skin.anchors, bent.patches, order};
        std::vector<Vec3> at_once = skin.positions;
        std::vector<Vec3> one_by_one = skin.positions;
        move_by_patches(shape, at_once);
        move_by_patches_scalar(shape, one_by_one);
        float moved = 0.0f;
        for (std::size_t i = 0; i < at_once.size(); ++i) {
            CHECK(glm::distance(at_once[i], one_by_one[i]) < 1e-6f);
            moved = std::max(moved, glm::distance(at_once[i], skin.positions[i]));
        }
        CHECK(moved > 0.1f);
    }
}

TEST_CASE("patches: no vertex moves farther than the bound" * technique("face.bids-rebuild")) {
    const Surface surface = make_bumpy();
    const Surface bent = map_surface(surface, bend);
    const Skin skin = skin_over(surface);
    const Skin moved = skin.follow(bent);
    float largest = 0.0f;
    for (const SurfaceAnchor& anchor : skin.anchors) {
        largest = std::max(largest, glm::length(anchor.offset));
    }
    const float most = max_motion(surface.patches, bent.patches, largest);
    float found = 0.0f;
    for (std::size_t i = 0; i < skin.positions.size(); ++i) {
        found = std::max(found, glm::distance(moved.positions[i], skin.positions[i]));
    }
    CHECK(found <= most);
    CHECK(most < 4 * found);
    CHECK(max_motion(surface.patches, surface.patches, largest) == 0.0f);
}

TEST_CASE(
    "patches: seams are closed, and triangulations that are no surface are rejected"
    * technique("face.bids-surface")) {
    Surface surface = make_bumpy(2);
    // The same with a vertex of its own for each corner.
    std::vector<Vec3> apart;
    std::vector<std::uint32_t> each;
    for (const std::uint32_t corner : surface.corners) {
        each.push_back(static_cast<std::uint32_t>(apart.size()));
        apart.push_back(surface.positions[corner]);
    }
    const std::vector<std::uint32_t> closed = make_patch_faces(apart, each)->corners;
    std::vector<Vec4> patches;
    make_patches(apart, closed, patches);
    CHECK(patches == surface.patches);
    CHECK(make_patch_faces(apart, each)->named == each);
    // Of different kinds, vertices at one position stay apart.
    std::vector<std::uint64_t> kinds(apart.size());
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        kinds[i] = i / 3 % 2;
    }
    const std::vector<std::uint32_t> torn = make_patch_faces(apart, each, kinds)->corners;
    for (std::size_t i = 0; i < torn.size(); ++i) {
        CHECK(kinds[torn[i]] == kinds[i]);
    }

    const auto error = [&](std::vector<std::uint32_t> more) {
        std::vector<std::uint32_t> indices = surface.corners;
        indices.insert(indices.end(), more.begin(), more.end());
        const auto result = make_patch_faces(surface.positions, indices);
        return result ? std::string("none") : result.error().message;
    };
    CHECK(error({}) == "none");
    CHECK(error({0, 0, 1}) == "none");
    const std::vector<Vec3> line = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    CHECK(
        make_patch_faces(line, std::vector<std::uint32_t>{0, 1, 2}).error().message
        == "triangle 0 has no area");
    CHECK(
        error({0, 3, 1}).find("vertices 0 and 3 with one that faces the opposite side")
        != std::string::npos);
    CHECK(error({1, 3, 8}).find("vertices 1 and 3 with two others") != std::string::npos);
    CHECK(make_patch_faces(surface.positions, {}).error().message == "it has no triangles");
}

TEST_CASE(
    "patches: markers that coincide, cross or are not finite give finite vertices"
    * technique("face.bids-surface")) {
    const Surface surface = make_bumpy();
    const Skin skin = skin_over(surface);
    for (const Surface& bad :
         {map_surface(surface, [](const Vec3&) { return Vec3(1); }),
          map_surface(surface, [](const Vec3& p) { return Vec3(p.x, 0, 0); }),
          map_surface(surface, [](const Vec3& p) { return Vec3(-p.x, p.y, p.z); })}) {
        const Skin moved = skin.follow(bad);
        for (std::size_t i = 0; i < skin.positions.size(); ++i) {
            CHECK(is_finite(moved.positions[i]));
            CHECK(is_finite(moved.normals[i]));
            CHECK(is_finite(Vec3(moved.tangents[i])));
        }
    }
}

}  // namespace limn::surface_patches_test
