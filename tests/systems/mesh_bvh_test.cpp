#include "ecs/base/rng.h"
#include "systems/particles/mesh_bvh.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace limn::mesh_bvh_test {

using namespace limn::test;

namespace {

using Dvec3 = glm::dvec3;

struct Mesh {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;
};

/// A closed, dented ball about `center`: rings x sectors quads of two triangles, fans at the poles.
/// Every ray from the center meets it once.
Mesh make_ball(int rings, int sectors, const Vec3& center, float dents) {
    Mesh mesh;
    Random random(1, 2, 3, 4);
    const auto add = [&](float polar, float around) {
        const float radius = 1.0f + dents * random.uniform(-1, 1);
        mesh.positions.push_back(
            center
            + radius
                  * Vec3(
                      std::sin(polar) * std::cos(around), std::cos(polar),
                      std::sin(polar) * std::sin(around)));
    };
    add(0, 0);
    for (int r = 1; r < rings; ++r) {
        for (int s = 0; s < sectors; ++s) {
            add(kPi * static_cast<float>(r) / static_cast<float>(rings),
                2 * kPi * static_cast<float>(s) / static_cast<float>(sectors));
        }
    }
    add(kPi, 0);
    const auto at = [&](int r, int s) {
        if (r == 0) {
            return 0u;
        }
        return r == rings ? static_cast<std::uint32_t>(mesh.positions.size() - 1)
                          : static_cast<std::uint32_t>(1 + (r - 1) * sectors + s % sectors);
    };
    for (int r = 0; r < rings; ++r) {
        for (int s = 0; s < sectors; ++s) {
            if (r > 0) {
                mesh.indices.insert(mesh.indices.end(), {at(r, s), at(r, s + 1), at(r + 1, s)});
            }
            if (r < rings - 1) {
                mesh.indices.insert(
                    mesh.indices.end(), {at(r, s + 1), at(r + 1, s + 1), at(r + 1, s)});
            }
        }
    }
    return mesh;
}

/// Brute force in double precision (Moeller and Trumbore 1997). `margin`: how far, in fractions and
/// barycentric coordinates, all triangles are from deciding the other way.
struct Reference {
    double fraction = std::numeric_limits<double>::infinity();
    double margin = std::numeric_limits<double>::infinity();
};

Reference first_hit_reference(const Mesh& mesh, const Segment& segment) {
    Reference first;
    const Dvec3 from(segment.from);
    const Dvec3 path = Dvec3(segment.to) - from;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const Dvec3 a(mesh.positions[mesh.indices[i]]);
        const Dvec3 ab = Dvec3(mesh.positions[mesh.indices[i + 1]]) - a;
        const Dvec3 ac = Dvec3(mesh.positions[mesh.indices[i + 2]]) - a;
        const Dvec3 p = glm::cross(path, ac);
        const double det = glm::dot(ab, p);
        const double u = glm::dot(from - a, p) / det;
        const Dvec3 q = glm::cross(from - a, ab);
        const double v = glm::dot(path, q) / det;
        const double t = glm::dot(ac, q) / det;
        const double inside = std::min({u, v, 1 - u - v, t, 1 - t});
        if (inside >= 0) {
            first.fraction = std::min(first.fraction, t);
        }
        if (!std::isnan(inside)) {
            first.margin = std::min(first.margin, std::abs(inside));
        }
    }
    return first;
}

Segment random_segment(Random& random, float length) {
    const Vec3 from = 1.3f * std::cbrt(random.uniform()) * random.direction();
    return {from, from + length * random.uniform() * random.direction()};
}

bool same_bits(const MeshHit& a, const MeshHit& b) {
    return std::memcmp(&a, &b, sizeof(MeshHit)) == 0;
}

}  // namespace

TEST_CASE("mesh bvh: the first hit is that of brute force in double precision") {
    const Mesh mesh = make_ball(14, 20, Vec3(0), 0.3f);
    const MeshBvh bvh = build_mesh_bvh(mesh.positions, mesh.indices);
    Random random(3, 3, 3, 3);
    int hits = 0;
    int decided = 0;
    for (int i = 0; i < 4000; ++i) {
        const Segment segment = random_segment(random, i % 2 == 0 ? 3.0f : 0.3f);
        const Reference expected = first_hit_reference(mesh, segment);
        if (expected.margin < 1e-5) {
            continue;  // an edge or an end: rounding decides
        }
        ++decided;
        const MeshHit found = first_hit(bvh, segment);
        REQUIRE((found.triangle != kNoTriangle) == (expected.fraction <= 1));
        if (found.triangle != kNoTriangle) {
            ++hits;
            CHECK(std::abs(static_cast<double>(found.fraction) - expected.fraction) < 2e-5);
        }
    }
    CHECK(decided > 3900);
    CHECK(hits > 800);
    CHECK(hits < 3000);
}

TEST_CASE("mesh bvh: a hit tells its triangle and the normal that sees it counterclockwise") {
    const Mesh mesh = {
        {{0, 0, 0}, {1, 0, 0}, {0, 0, -1}, {0, -1, 0}, {1, -1, 0}, {0, -1, -1}},
        {3, 4, 5, 0, 1, 2}};
    const MeshBvh bvh = build_mesh_bvh(mesh.positions, mesh.indices);
    const MeshHit down = first_hit(bvh, {{0.25f, 1, -0.25f}, {0.25f, -3, -0.25f}});
    CHECK(down.triangle == 1);
    CHECK(down.fraction == near(0.25));
    CHECK(glm::distance(down.normal, Vec3(0, 1, 0)) < 1e-6f);
    const MeshHit up = first_hit(bvh, {{0.25f, -2, -0.25f}, {0.25f, 2, -0.25f}});
    CHECK(up.triangle == 0);
    CHECK(up.fraction == near(0.25));
    CHECK(glm::distance(up.normal, Vec3(0, 1, 0)) < 1e-6f);
    CHECK(first_hit(bvh, {{0.25f, 1, -0.25f}, {0.25f, 0.01f, -0.25f}}).triangle == kNoTriangle);
    CHECK(first_hit(bvh, {{0.75f, 1, -0.75f}, {0.75f, -3, -0.75f}}).triangle == kNoTriangle);
}

TEST_CASE("mesh bvh: nothing leaks out of a closed mesh, through no edge and no vertex") {
    for (const Vec3 center : {Vec3(0), Vec3(37.1f, -250.3f, 411.7f)}) {
        const Mesh mesh = make_ball(16, 24, center, 0.2f);
        const MeshBvh bvh = build_mesh_bvh(mesh.positions, mesh.indices);
        Random random(4, 4, 4, 4);
        int leaks = 0;
        for (int i = 0; i < 60000; ++i) {
            // Through a vertex, a point of an edge or one of a triangle.
            const std::size_t first =
                3 * random.below(static_cast<std::uint32_t>(mesh.indices.size() / 3));
            const Vec3& a = mesh.positions[mesh.indices[first]];
            const Vec3& b = mesh.positions[mesh.indices[first + 1]];
            const Vec3& c = mesh.positions[mesh.indices[first + 2]];
            Vec3 aim = a;
            if (i % 3 == 1) {
                aim += random.uniform() * (b - a);
            } else if (i % 3 == 2) {
                aim += 0.5f * random.uniform() * (b - a) + 0.5f * random.uniform() * (c - a);
            }
            const Vec3 from = center + 0.4f * random.uniform() * random.direction();
            const Vec3 to = from + random.uniform(3, 40) * glm::normalize(aim - from);
            leaks += first_hit(bvh, {from, to}).triangle == kNoTriangle ? 1 : 0;
            leaks += first_hit(bvh, {to, from}).triangle == kNoTriangle ? 1 : 0;
        }
        CHECK(leaks == 0);
    }
}

TEST_CASE("mesh bvh: a mesh so small that products of its coordinates vanish does not leak") {
    Mesh mesh = make_ball(8, 12, Vec3(0), 0.2f);
    for (Vec3& p : mesh.positions) {
        p *= 1e-24f;
    }
    const MeshBvh bvh = build_mesh_bvh(mesh.positions, mesh.indices);
    Random random(4, 4, 4, 5);
    int leaks = 0;
    for (int i = 0; i < 2000; ++i) {
        leaks += first_hit(bvh, {Vec3(0), 3e-24f * random.direction()}).triangle == kNoTriangle;
    }
    CHECK(leaks == 0);
}

TEST_CASE("mesh bvh: along an axis, in the plane of faces and along edges a box does not leak") {
    Mesh box;
    for (int i = 0; i < 8; ++i) {
        box.positions.emplace_back(i & 1, (i >> 1) & 1, (i >> 2) & 1);
    }
    box.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                   2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    const MeshBvh bvh = build_mesh_bvh(box.positions, box.indices);
    for (int axis = 0; axis < 3; ++axis) {
        for (const float u : {0.0f, 0.25f, 0.5f, 1.0f}) {
            for (const float v : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
                Vec3 from(-1);
                from[(axis + 1) % 3] = u;
                from[(axis + 2) % 3] = v;
                Vec3 to = from;
                to[axis] = 2;
                CAPTURE(axis);
                CAPTURE(u);
                CAPTURE(v);
                const MeshHit forth = first_hit(bvh, {from, to});
                const MeshHit back = first_hit(bvh, {to, from});
                CHECK(forth.triangle != kNoTriangle);
                CHECK(back.triangle != kNoTriangle);
                CHECK(forth.fraction == near(1.0 / 3));
                CHECK(back.fraction == near(1.0 / 3));
            }
        }
    }
}

TEST_CASE("mesh bvh: a segment cut in two at the surface does not slip between its halves") {
    const Mesh mesh = make_ball(16, 24, {5, 6, 7}, 0.2f);
    const MeshBvh bvh = build_mesh_bvh(mesh.positions, mesh.indices);
    Random random(5, 5, 5, 5);
    int leaks = 0;
    for (int i = 0; i < 30000; ++i) {
        const Vec3 from = Vec3(5, 6, 7) + 0.4f * random.uniform() * random.direction();
        const Vec3 to = from + 3.0f * random.direction();
        const MeshHit whole = first_hit(bvh, {from, to});
        const Vec3 center = from + whole.fraction * (to - from);
        const bool hit = first_hit(bvh, {from, center}).triangle != kNoTriangle
                         || first_hit(bvh, {center, to}).triangle != kNoTriangle;
        leaks += hit ? 0 : 1;
    }
    CHECK(leaks == 0);
}

TEST_CASE("mesh bvh: of equally near triangles the first counts, wherever it is in the tree") {
    Mesh mesh = make_ball(8, 12, Vec3(0), 0.1f);
    const std::size_t count = mesh.indices.size();
    const MeshBvh once = build_mesh_bvh(mesh.positions, mesh.indices);
    for (int copy = 0; copy < 20; ++copy) {
        for (std::size_t i = 0; i < count; ++i) {
            mesh.indices.push_back(mesh.indices[i]);
        }
    }
    const MeshBvh often = build_mesh_bvh(mesh.positions, mesh.indices);
    Random random(6, 6, 6, 6);
    for (int i = 0; i < 2000; ++i) {
        const Segment segment = random_segment(random, 3);
        CHECK(same_bits(first_hit(once, segment), first_hit(often, segment)));
    }
}

TEST_CASE("mesh bvh: a batch in Morton order gives the bits of single segments") {
    const Mesh mesh = make_ball(30, 40, {100, 0, 0}, 0.1f);
    const MeshBvh bvh = build_mesh_bvh(mesh.positions, mesh.indices);
    Random random(7, 7, 7, 7);
    std::vector<Segment> segments(5000);
    for (Segment& segment : segments) {
        segment = random_segment(random, 2);
        segment.from.x += 100;
        segment.to.x += 100;
    }
    segments[17].from.x = std::nanf("");
    segments[18].to.y = std::numeric_limits<float>::infinity();
    segments[19].to = segments[19].from;
    SegmentBatch batch;
    std::vector<MeshHit> hits(segments.size());
    first_hits(bvh, segments, hits, batch);
    std::size_t found = 0;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        CHECK(same_bits(hits[i], first_hit(bvh, segments[i])));
        found += hits[i].triangle != kNoTriangle ? 1 : 0;
    }
    CHECK(found > 1000);
    for (const std::size_t none : {17, 18, 19}) {
        CHECK(hits[none].triangle == kNoTriangle);
    }
    // Neighbors in the order are neighbors in space.
    float ordered = 0;
    float unordered = 0;
    for (std::size_t i = 101; i < segments.size(); ++i) {
        unordered += glm::distance(segments[i - 1].to, segments[i].from);
        if (batch.order[i - 1] > 19 && batch.order[i] > 19) {
            ordered +=
                glm::distance(segments[batch.order[i - 1]].to, segments[batch.order[i]].from);
        }
    }
    CHECK(ordered < 0.7f * unordered);
}

TEST_CASE("mesh bvh: any SIMD width gives the same bits") {
    const Mesh mesh = make_ball(14, 20, Vec3(0), 0.3f);
    const MeshBvh bvh = build_mesh_bvh(mesh.positions, mesh.indices);
    Random random(8, 8, 8, 8);
    std::vector<Segment> segments;
    for (int i = 0; i < 2000; ++i) {
        segments.push_back(random_segment(random, 2));
    }
    std::vector<MeshHit> expected;
    for (const Segment& segment : segments) {
        expected.push_back(first_hit(bvh, segment));
    }
    int targets = 0;
    for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
        hwy::SetSupportedTargetsForTest(left & -left);
        for (std::size_t i = 0; i < segments.size(); ++i) {
            REQUIRE(same_bits(first_hit(bvh, segments[i]), expected[i]));
        }
        ++targets;
    }
    hwy::SetSupportedTargetsForTest(0);
    CHECK(targets >= 1);
}

TEST_CASE("mesh bvh: a refitted tree finds what a new one does") {
    Mesh mesh = make_ball(20, 30, Vec3(0), 0.2f);
    MeshBvh bvh = build_mesh_bvh(mesh.positions, mesh.indices);
    for (Vec3& p : mesh.positions) {
        p = {1.2f * p.x + 0.3f * p.y, 0.8f * p.y, p.z + 0.2f * std::sin(5 * p.x)};
    }
    refit_mesh_bvh(bvh, mesh.positions, mesh.indices);
    const MeshBvh fresh = build_mesh_bvh(mesh.positions, mesh.indices);
    Random random(9, 9, 9, 9);
    int hits = 0;
    for (int i = 0; i < 3000; ++i) {
        const Segment segment = random_segment(random, 2);
        const MeshHit found = first_hit(bvh, segment);
        CHECK(same_bits(found, first_hit(fresh, segment)));
        hits += found.triangle != kNoTriangle ? 1 : 0;
    }
    CHECK(hits > 500);
}

TEST_CASE("mesh bvh: built twice it has the same bits, and holds each triangle once") {
    const Mesh mesh = make_ball(20, 30, Vec3(0), 0.2f);
    const MeshBvh a = build_mesh_bvh(mesh.positions, mesh.indices);
    const MeshBvh b = build_mesh_bvh(mesh.positions, mesh.indices);
    REQUIRE(a.nodes.size() == b.nodes.size());
    REQUIRE(a.leaves.size() == b.leaves.size());
    CHECK(std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(a.nodes[0])) == 0);
    std::vector<int> counts(mesh.indices.size() / 3);
    for (std::size_t i = 0; i < a.leaves.size(); ++i) {
        for (std::size_t lane = 0; lane < MeshBvh::kTriangles; ++lane) {
            CHECK(a.leaves[i].triangle[lane] == b.leaves[i].triangle[lane]);
            if (a.leaves[i].triangle[lane] != kNoTriangle) {
                ++counts[a.leaves[i].triangle[lane]];
            }
        }
    }
    CHECK(std::all_of(counts.begin(), counts.end(), [](int times) { return times == 1; }));
}

TEST_CASE("mesh bvh: empty meshes and triangles that are none are never hit, others stay") {
    const Segment down = {{0.2f, 1, -0.2f}, {0.2f, -1, -0.2f}};
    CHECK(first_hit(MeshBvh{}, down).triangle == kNoTriangle);
    CHECK(first_hit(build_mesh_bvh({}, {}), down).triangle == kNoTriangle);
    const float nan = std::nanf("");
    const float inf = std::numeric_limits<float>::infinity();
    std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0},    {0, 0, -1},   {nan, 0, 0},  {0, inf, 0},
                                   {2, 0, 0}, {0, 0.5f, 0}, {1, 0.5f, 0}, {0, 0.5f, -1}};
    const std::vector<std::uint32_t> indices = {0, 3, 2, 0,  4, 2, 0, 1, 5, 0, 0,
                                                1, 0, 1, 99, 0, 1, 2, 6, 7, 8};
    MeshBvh bvh = build_mesh_bvh(positions, indices);
    CHECK(first_hit(bvh, down).triangle == 6);
    CHECK(first_hit(bvh, down).fraction == near(0.25));
    for (const float gone : {nan, inf}) {  // the upper one goes, and comes back
        positions[7].x = gone;
        refit_mesh_bvh(bvh, positions, indices);
        CHECK(bvh.largest == 1);
        CHECK(first_hit(bvh, down).triangle == 5);
        CHECK(first_hit(bvh, down).fraction == near(0.5));
    }
    positions[7].x = 1;
    refit_mesh_bvh(bvh, positions, indices);
    CHECK(first_hit(bvh, down).triangle == 6);

    const std::vector<std::uint32_t> none = {0, 3, 2, 0, 0, 1};
    const MeshBvh empty = build_mesh_bvh(positions, none);
    CHECK(empty.nodes.empty());
    CHECK(first_hit(empty, down).triangle == kNoTriangle);
    SegmentBatch batch;
    std::vector<MeshHit> hits(1, MeshHit{.triangle = 3});
    first_hits(empty, {&down, 1}, hits, batch);
    CHECK(hits[0].triangle == kNoTriangle);
}

TEST_CASE(
    "mesh bvh: thousands of triangles at one position, or at ever smaller scales, are built") {
    Mesh heap;
    Mesh nested;
    for (int i = 0; i < 3000; ++i) {
        const float scale = std::exp2(-static_cast<float>(i % 100));
        for (const Vec3 corner : {Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(0, 1, -1)}) {
            heap.indices.push_back(static_cast<std::uint32_t>(heap.positions.size()));
            heap.positions.push_back(corner);
            nested.indices.push_back(static_cast<std::uint32_t>(nested.positions.size()));
            nested.positions.push_back(scale * corner);
        }
    }
    const Segment down = {{0.1f, 2, -0.1f}, {0.1f, 0, -0.1f}};
    CHECK(first_hit(build_mesh_bvh(heap.positions, heap.indices), down).triangle == 0);
    const MeshBvh bvh = build_mesh_bvh(nested.positions, nested.indices);
    CHECK(first_hit(bvh, down).triangle == 0);
    CHECK(first_hit(bvh, {{0, -1, 0}, {1e-3f, 1, -1e-3f}}).triangle != kNoTriangle);
}

}  // namespace limn::mesh_bvh_test
