#include "content/make/models/bezier_patch.h"
#include "ecs/base/rng.h"
#include "tests/content/mesh_laws.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <set>

namespace limn::bezier_patch_test {

using namespace limn::test;

namespace {

using Curve2 = std::array<Vec2, 4>;
constexpr Curve2 kArch = {Vec2(0, 0), Vec2(0, 1), Vec2(1, 1), Vec2(1, 0)};

/// P_ij = (i/3, j/3, 0): the unit square.
BezierPatch unit_square() {
    BezierPatch patch;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            patch.p[i][j] = {static_cast<float>(i) / 3.0f, static_cast<float>(j) / 3.0f, 0};
        }
    }
    return patch;
}

/// The square with every point shaken by up to 0.15.
BezierPatch crumpled(std::uint64_t seed) {
    BezierPatch patch = unit_square();
    Random random(seed, 0, name_hash("crumpled"), 0);
    for (auto& row : patch.p) {
        for (Vec3& point : row) {
            point += 0.15f * random.direction() * random.uniform();
        }
    }
    return patch;
}

/// The surface in double precision, straight from the definition.
glm::dvec3 exact_point(const BezierPatch& patch, double u, double v) {
    const auto weights = [](double t) {
        const double s = 1 - t;
        return std::array<double, 4>{s * s * s, 3 * t * s * s, 3 * t * t * s, t * t * t};
    };
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            sum += weights(u)[i] * weights(v)[j] * glm::dvec3(patch.p[i][j]);
        }
    }
    return sum;
}

float apart(const Vec3& a, const glm::dvec3& b) {
    return static_cast<float>(glm::length(glm::dvec3(a) - b));
}

}  // namespace

TEST_CASE(
    "bezier_patch: the weights of a cubic sum to 1, are positive inside, and their slopes sum to 0"
    * technique("anim.bezier-eval")) {
    for (int k = 0; k <= 100; ++k) {
        const float u = static_cast<float>(k) / 100.0f;
        const Vec4 b = bernstein(u);
        CHECK(b.x + b.y + b.z + b.w == test::near(1.0f).epsilon(1e-6));
        if (k > 0 && k < 100) {
            CHECK(glm::min(glm::min(b.x, b.y), glm::min(b.z, b.w)) > 0);
        }
    }
}

TEST_CASE(
    "bezier_patch: a curve has its closed-form points, ends and end slopes"
    * technique("anim.bezier-eval")) {
    CHECK(bezier_point(kArch, 0.25f) == Vec2(0.15625f, 0.5625f));
    CHECK(bezier_point(kArch, 0.5f) == Vec2(0.5f, 0.75f));
    CHECK(bezier_point(kArch, 0.0f) == kArch[0]);
    CHECK(bezier_point(kArch, 1.0f) == kArch[3]);
    CHECK(bezier_derivative(kArch, 0.0f) == 3.0f * (kArch[1] - kArch[0]));
    CHECK(bezier_derivative(kArch, 1.0f) == 3.0f * (kArch[3] - kArch[2]));
    const float h = 1e-3f;
    const Vec2 slope = (bezier_point(kArch, h) - bezier_point(kArch, 0.0f)) / h;
    CHECK(glm::length(slope - bezier_derivative(kArch, 0.0f)) < 2e-2f);
}

TEST_CASE("bezier_patch: equally spaced points on a line give constant speed") {
    const std::array<float, 4> line = {2, 3, 4, 5};
    for (int k = 0; k <= 10; ++k) {
        const float u = static_cast<float>(k) / 10.0f;
        CHECK(bezier_point(line, u) == test::near(2 + 3 * u).epsilon(1e-6));
    }
}

TEST_CASE("bezier_patch: a curve read backwards gives the same bits") {
    const Curve2 p = {Vec2(0.1f, 0.7f), Vec2(1.3f, -0.2f), Vec2(0.9f, 2.1f), Vec2(-0.4f, 0.3f)};
    const Curve2 q = {p[3], p[2], p[1], p[0]};
    for (int k = 0; k <= 64; ++k) {
        const float u = static_cast<float>(k) / 64.0f;
        CHECK(bezier_point(p, u) == bezier_point(q, 1.0f - u));
    }
}

TEST_CASE(
    "bezier_patch: affine maps commute with a curve, a perspective divide does not"
    * technique("anim.bezier-eval")) {
    const std::array<Vec3, 4> p = {Vec3(0, 0, 1), Vec3(0, 1, 2), Vec3(1, 1, 4), Vec3(1, 0, 3)};
    const Affine map =
        affine_from({1, 2, 3}, glm::normalize(Quat(0.3f, 0.5f, -0.2f, 0.7f)), {2, 0.5f, 1.5f});
    std::array<Vec3, 4> mapped;
    std::array<Vec3, 4> projected;
    for (std::size_t i = 0; i < 4; ++i) {
        mapped[i] = transform_point(map, p[i]);
        projected[i] = p[i] / p[i].z;
    }
    float affine_error = 0;
    float perspective_error = 0;
    for (int k = 0; k <= 20; ++k) {
        const float u = static_cast<float>(k) / 20.0f;
        const Vec3 q = bezier_point(p, u);
        affine_error =
            std::max(affine_error, glm::length(transform_point(map, q) - bezier_point(mapped, u)));
        perspective_error =
            std::max(perspective_error, glm::length(q / q.z - bezier_point(projected, u)));
    }
    CHECK(affine_error < 1e-5f);
    CHECK(perspective_error > 1e-3f);
}

TEST_CASE("bezier_patch: curve and surface stay inside the box of their control points") {
    const BezierPatch patch = crumpled(7);
    Bounds box;
    for (const auto& row : patch.p) {
        for (const Vec3& point : row) {
            grow(box, point);
        }
    }
    for (int k = 0; k <= 400; ++k) {
        const Vec3 q = patch_point(
            patch, static_cast<float>(k % 21) / 20.0f, static_cast<float>(k / 21) / 20.0f);
        CHECK(glm::all(glm::greaterThanEqual(q, box.min - 1e-6f)));
        CHECK(glm::all(glm::lessThanEqual(q, box.max + 1e-6f)));
    }
}

TEST_CASE(
    "bezier_patch: the corners are control points and u belongs to the first index"
    * technique("anim.bezier-patch")) {
    const BezierPatch patch = crumpled(1);
    CHECK(patch_point(patch, 0, 0) == patch.p[0][0]);
    CHECK(patch_point(patch, 1, 0) == patch.p[3][0]);
    CHECK(patch_point(patch, 0, 1) == patch.p[0][3]);
    CHECK(patch_point(patch, 1, 1) == patch.p[3][3]);
}

TEST_CASE(
    "bezier_patch: the unit square is (u, v, 0) with the frame of the axes"
    * technique("bump.tangent-bezier")) {
    const BezierPatch square = unit_square();
    for (const float u : {0.0f, 0.3f, 1.0f}) {
        for (const float v : {0.0f, 0.6f, 1.0f}) {
            CHECK(apart(patch_point(square, u, v), {u, v, 0}) < 1e-6f);
            CHECK(apart(patch_du(square, u, v), {1, 0, 0}) < 1e-6f);
            CHECK(apart(patch_dv(square, u, v), {0, 1, 0}) < 1e-6f);
            CHECK(apart(patch_duv(square, u, v), {0, 0, 0}) < 1e-5f);
            CHECK(apart(patch_frame(square, u, v).normal, {0, 0, 1}) < 1e-6f);
            CHECK(apart(patch_frame(square, u, v).tangent, {1, 0, 0}) < 1e-6f);
        }
    }
}

TEST_CASE(
    "bezier_patch: one inner point lifts the center by 9/64 and no boundary"
    * technique("anim.bezier-patch")) {
    BezierPatch patch = unit_square();
    patch.p[1][1].z = 1;
    CHECK(patch_point(patch, 0.5f, 0.5f).z == test::near(0.140625));
    for (int k = 0; k <= 16; ++k) {
        const float t = static_cast<float>(k) / 16.0f;
        CHECK(patch_point(patch, t, 0).z == 0);
        CHECK(patch_point(patch, t, 1).z == 0);
        CHECK(patch_point(patch, 0, t).z == 0);
        CHECK(patch_point(patch, 1, t).z == 0);
    }
}

TEST_CASE("bezier_patch: a boundary is the curve of its own control points") {
    const BezierPatch patch = crumpled(3);
    const std::array<Vec3, 4> low = {patch.p[0][0], patch.p[1][0], patch.p[2][0], patch.p[3][0]};
    for (int k = 0; k <= 32; ++k) {
        const float t = static_cast<float>(k) / 32.0f;
        CHECK(patch_point(patch, t, 0) == bezier_point(low, t));
        CHECK(patch_point(patch, 1, t) == bezier_point(patch.p[3], t));
    }
}

TEST_CASE(
    "bezier_patch: an affine map of the control points maps the surface"
    * technique("anim.bezier-patch")) {
    const BezierPatch patch = crumpled(4);
    const Affine map =
        affine_from({-1, 0.5f, 2}, glm::normalize(Quat(0.9f, 0.1f, 0.4f, -0.3f)), {1, 2, 0.5f});
    BezierPatch mapped = patch;
    for (auto& row : mapped.p) {
        for (Vec3& point : row) {
            point = transform_point(map, point);
        }
    }
    for (const float u : {0.1f, 0.5f, 0.8f}) {
        CHECK(
            glm::length(
                transform_point(map, patch_point(patch, u, 0.4f)) - patch_point(mapped, u, 0.4f))
            < 1e-5f);
    }
}

TEST_CASE(
    "bezier_patch: derivatives agree with differences, and with the control points at the corner"
    * technique("anim.bezier-patch-frame, bump.tangent-bezier")) {
    const BezierPatch patch = crumpled(2);
    const double h = 1e-3;
    for (const double u : {0.2, 0.5, 0.9}) {
        for (const double v : {0.1, 0.6}) {
            const auto [fu, fv] = std::pair(static_cast<float>(u), static_cast<float>(v));
            const auto p = [&](double du, double dv) { return exact_point(patch, u + du, v + dv); };
            CHECK(apart(patch_du(patch, fu, fv), (p(h, 0) - p(-h, 0)) / (2 * h)) < 1e-3f);
            CHECK(apart(patch_dv(patch, fu, fv), (p(0, h) - p(0, -h)) / (2 * h)) < 1e-3f);
            const glm::dvec3 mixed = (p(h, h) - p(h, -h) - p(-h, h) + p(-h, -h)) / (4 * h * h);
            CHECK(apart(patch_duv(patch, fu, fv), mixed) < 1e-3f);
        }
    }
    const auto& p = patch.p;
    CHECK(glm::length(patch_du(patch, 0, 0) - 3.0f * (p[1][0] - p[0][0])) < 1e-6f);
    CHECK(glm::length(patch_dv(patch, 0, 0) - 3.0f * (p[0][1] - p[0][0])) < 1e-6f);
    CHECK(
        glm::length(patch_duv(patch, 0, 0) - 9.0f * (p[0][0] - p[0][1] - p[1][0] + p[1][1]))
        < 1e-5f);
    const Vec3 corner_normal = glm::normalize(glm::cross(p[1][0] - p[0][0], p[0][1] - p[0][0]));
    CHECK(glm::length(patch_frame(patch, 0, 0).normal - corner_normal) < 1e-5f);
}

TEST_CASE(
    "bezier_patch: the saddle z = u v has the mixed derivative 1"
    * technique("anim.bezier-patch-frame")) {
    BezierPatch saddle = unit_square();
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            saddle.p[i][j].z = static_cast<float>(i * j) / 9.0f;
        }
    }
    CHECK(patch_duv(saddle, 0, 0).z == test::near(1.0f));
    CHECK(patch_duv(saddle, 0.7f, 0.2f).z == test::near(1.0f));
    CHECK(patch_point(saddle, 0.7f, 0.2f).z == test::near(0.14f));
}

TEST_CASE(
    "bezier_patch: where an edge is a point, the frame is the limit from inside"
    * technique("anim.bezier-patch-frame")) {
    // A quarter of a cone whose tip is the edge v = 1.
    BezierPatch cone = unit_square();
    for (std::size_t i = 0; i < 4; ++i) {
        cone.p[i][3] = {0.5f, 1, 1};
    }
    const PatchFrame tip = patch_frame(cone, 0.5f, 1.0f);
    const PatchFrame near_tip = patch_frame(cone, 0.5f, 0.99f);
    CHECK(glm::dot(tip.normal, near_tip.normal) > 0.999f);
    CHECK(glm::dot(tip.tangent, near_tip.tangent) > 0.999f);

    BezierPatch point = {};
    const PatchFrame nowhere = patch_frame(point, 0.3f, 0.3f);
    CHECK(glm::length(nowhere.normal) == test::near(1.0f));
    CHECK(glm::length(nowhere.tangent) == test::near(1.0f));
}

TEST_CASE(
    "bezier_patch: four children are the parent" * technique("anim.bezier-patch-tessellate")) {
    const BezierPatch patch = crumpled(5);
    const std::array<BezierPatch, 4> children = split_patch(patch);
    for (int k = 0; k < 25; ++k) {
        const float s = static_cast<float>(k % 5) / 4.0f;
        const float t = static_cast<float>(k / 5) / 4.0f;
        for (std::size_t child = 0; child < 4; ++child) {
            const float u = 0.5f * (s + static_cast<float>(child % 2));
            const float v = 0.5f * (t + static_cast<float>(child / 2));
            CHECK(
                glm::length(patch_point(children[child], s, t) - patch_point(patch, u, v)) < 1e-6f);
        }
    }
}

TEST_CASE(
    "bezier_patch: uniform depth 2 makes 16 quads with 25 vertices, all on the surface"
    * technique("anim.bezier-patch-tessellate")) {
    const BezierPatch patch = crumpled(6);
    const PatchTriangles triangles = tessellate_uniform(1, 4);
    CHECK(triangles.samples.size() == 25);
    CHECK(triangles.indices.size() == 3 * 32);
    const MeshData mesh = make_patch_mesh(std::span(&patch, 1), triangles);
    check_arrays(mesh);
    for (std::size_t i = 0; i < 25; ++i) {
        const glm::dvec3 exact = exact_point(patch, mesh.uvs[i].x, 1.0 - mesh.uvs[i].y);
        CHECK(apart(mesh.positions[i], exact) < 1e-5f);
    }
    CHECK(worst_facing(mesh) > 0);
    CHECK(worst_tangent(mesh) > 0.5f);
}

TEST_CASE(
    "bezier_patch: the error of flat quads falls by a factor of four with each depth"
    * technique("anim.bezier-patch-tessellate")) {
    const BezierPatch patch = crumpled(8);
    const auto worst_error = [&](int divisions) {
        double worst = 0;
        for (int j = 0; j < divisions; ++j) {
            for (int i = 0; i < divisions; ++i) {
                const double h = 1.0 / divisions;
                const double u = i * h;
                const double v = j * h;
                const glm::dvec3 flat =
                    0.5 * (exact_point(patch, u, v) + exact_point(patch, u + h, v + h));
                worst = std::max(
                    worst, glm::length(flat - exact_point(patch, u + 0.5 * h, v + 0.5 * h)));
            }
        }
        return worst;
    };
    CHECK(worst_error(16) / worst_error(32) == test::near(4.0).epsilon(0.15));
    CHECK(worst_error(32) / worst_error(64) == test::near(4.0).epsilon(0.1));
}

TEST_CASE("bezier_patch: a flat patch stays one quad, a bent one gets more where it bends") {
    const BezierPatch square = unit_square();
    const PatchTriangles flat = tessellate_adaptive(std::span(&square, 1), 1e-4f);
    CHECK(flat.samples.size() == 4);
    CHECK(flat.indices.size() == 6);

    BezierPatch bent = square;
    bent.p[3][3].z = 1;
    const PatchTriangles fine = tessellate_adaptive(std::span(&bent, 1), 1e-3f);
    const PatchTriangles coarse = tessellate_adaptive(std::span(&bent, 1), 1e-1f);
    CHECK(fine.indices.size() > coarse.indices.size());
    CHECK(coarse.indices.size() > 6);
    int near_bend = 0;
    for (const PatchSample& sample : fine.samples) {
        near_bend += sample.u + sample.v > 1 ? 1 : 0;
    }
    CHECK(2 * near_bend > static_cast<int>(fine.samples.size()));
}

TEST_CASE(
    "bezier_patch: adaptive tessellation has no T-junctions, not even between patches"
    * technique("anim.bezier-patch-tessellate")) {
    // A flat patch and a bent one, which share the boundary u = 1 / u = 0, that one read backwards.
    BezierPatch left = unit_square();
    left.p[3][1].z = 0.4f;
    left.p[3][2].z = -0.3f;
    BezierPatch right;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            right.p[i][j] = left.p[3][j] + Vec3(static_cast<float>(i) / 3.0f, 0, 0);
        }
    }
    right.p[2][1].z = 2;
    BezierPatch flipped;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            flipped.p[i][j] = right.p[3 - i][3 - j];
        }
    }
    const BezierPatch patches[] = {left, flipped};
    const MeshData mesh = make_patch_mesh(patches, tessellate_adaptive(patches, 0.01f));

    // An open edge must lie on the outline: x = 0, x = 2, y = 0 or y = 1.
    int inside = 0;
    const int open = open_edges(mesh, [&](const Vec3& a, const Vec3& b) {
        const bool on_outline = glm::max(a.x, b.x) < 1e-5f || glm::min(a.x, b.x) > 1.99999f
                                || glm::max(a.y, b.y) < 1e-5f || glm::min(a.y, b.y) > 0.99999f;
        inside += on_outline ? 0 : 1;
    });
    CHECK(inside == 0);
    CHECK(open > 8);
}

TEST_CASE(
    "bezier_patch: level l has 4^l sub-patches of the same surface, ever closer to control points"
    * technique("anim.bezier-patch-lod")) {
    const BezierPatch patch = crumpled(9);
    const PatchLevels levels = make_patch_levels(patch, 4);
    float last = 1e9f;
    for (std::size_t l = 0; l < 4; ++l) {
        const std::size_t side = std::size_t{1} << l;
        REQUIRE(levels.level[l].size() == side * side);
        float distance = 0;
        for (std::size_t k = 0; k < side * side; ++k) {
            const BezierPatch& sub = levels.level[l][k];
            const double u = (static_cast<double>(k % side) + 0.25) / static_cast<double>(side);
            const double v = (static_cast<double>(k / side) + 0.5) / static_cast<double>(side);
            REQUIRE(apart(patch_point(sub, 0.25f, 0.5f), exact_point(patch, u, v)) < 1e-5f);
            for (std::size_t i = 0; i < 4; ++i) {
                for (std::size_t j = 0; j < 4; ++j) {
                    const Vec3 q = patch_point(
                        sub, static_cast<float>(i) / 3.0f, static_cast<float>(j) / 3.0f);
                    distance = std::max(distance, glm::length(sub.p[i][j] - q));
                }
            }
        }
        CHECK(distance < last);
        last = distance;
    }
}

}  // namespace limn::bezier_patch_test
