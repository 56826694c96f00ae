#include "content/bake/ray_caster.h"
#include "content/make/models/shapes.h"
#include "ecs/base/jobs.h"
#include "ecs/components/surface.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <vector>

namespace limn::ray_caster_test {
namespace {

using DVec3 = glm::dvec3;

struct TruthHit {
    double t = std::numeric_limits<double>::infinity();
    std::uint32_t triangle = 0;
    double margin = 0;  ///< of the point from the triangle's edges, as a barycentric coordinate
};

/// All triangles, one by one, by planes and signed areas. `slack`: how far outside still counts.
TruthHit find_by_brute_force(const MeshData& mesh, const MeshRay& ray, double slack) {
    TruthHit best;
    const DVec3 d(ray.direction);
    for (std::uint32_t i = 0; i < mesh.indices.size() / 3; ++i) {
        DVec3 p[3];
        for (std::size_t k = 0; k < 3; ++k) {
            p[k] = DVec3(mesh.positions[mesh.indices[std::size_t{3} * i + k]]);
        }
        const DVec3 n = glm::cross(p[1] - p[0], p[2] - p[0]);
        const double t = glm::dot(p[0] - DVec3(ray.origin), n) / glm::dot(d, n);
        if (!(t >= ray.min_t && t <= ray.max_t)) {
            continue;
        }
        const DVec3 x = DVec3(ray.origin) + t * d;
        double least = 1;
        for (int k = 0; k < 3; ++k) {
            const DVec3 side = glm::cross(p[(k + 1) % 3] - p[k], x - p[k]);
            least = std::min(least, glm::dot(side, n) / glm::dot(n, n));
        }
        if (least >= -slack && t < best.t) {
            best = {t, i, least};
        }
    }
    return best;
}

/// A closed, bent surface that overlaps itself along many rays.
MeshData make_two_spheres() {
    MeshData mesh = make_sphere({.radius = 1, .segments = 16, .rings = 8});
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const std::size_t count = mesh.indices.size();
    for (std::uint32_t v = 0; v < first; ++v) {
        mesh.positions.push_back(0.7f * mesh.positions[v] + Vec3(0.6f, 0.1f, -0.2f));
    }
    for (std::size_t i = 0; i < count; ++i) {
        mesh.indices.push_back(first + mesh.indices[i]);
    }
    return mesh;
}

MeshRay random_ray(std::mt19937& random) {
    std::uniform_real_distribution<float> place(-2, 2);
    const Vec3 from = {place(random), place(random), place(random)};
    const Vec3 to = {place(random), place(random), place(random)};
    return {.origin = from, .direction = 0.3f * (to - from)};
}

}  // namespace

TEST_CASE("ray caster: nearest hits are those of a search over all triangles") {
    const MeshData mesh = make_two_spheres();
    const RayCaster caster(mesh.positions, mesh.indices);
    std::mt19937 random(7);
    int compared = 0;
    int hits = 0;
    for (int i = 0; i < 800; ++i) {
        const MeshRay ray = random_ray(random);
        const TruthHit outer = find_by_brute_force(mesh, ray, 1e-5);
        const TruthHit inner = find_by_brute_force(mesh, ray, -1e-5);
        const std::optional<RayHit> found = caster.nearest(ray);
        if (outer.t != inner.t) {
            continue;  // at an edge
        }
        ++compared;
        REQUIRE(found.has_value() == std::isfinite(inner.t));
        if (found) {
            ++hits;
            CHECK(found->triangle == inner.triangle);
            CHECK(found->t == static_cast<float>(inner.t));
        }
    }
    CHECK(compared > 780);
    CHECK(hits > 130);
}

TEST_CASE("ray caster: the weights of a hit give the point on the ray") {
    const MeshData mesh = make_two_spheres();
    const RayCaster caster(mesh.positions, mesh.indices);
    std::mt19937 random(8);
    for (int i = 0; i < 1000; ++i) {
        const MeshRay ray = random_ray(random);
        if (const std::optional<RayHit> hit = caster.nearest(ray)) {
            const Vec3 point = at_hit<Vec3>(*hit, mesh.indices, mesh.positions);
            CHECK(glm::length(point - (ray.origin + hit->t * ray.direction)) < 2e-6f);
            CHECK(std::abs(hit->weights.x + hit->weights.y + hit->weights.z - 1) < 1e-6f);
        }
    }
}

TEST_CASE("ray caster: all hits come in order, the first is the nearest, and sides alternate") {
    const MeshData mesh = make_sphere({.radius = 1, .segments = 24, .rings = 12});
    const RayCaster caster(mesh.positions, mesh.indices);
    std::mt19937 random(9);
    std::vector<RayHit> hits;
    int pairs = 0;
    for (int i = 0; i < 1000; ++i) {
        MeshRay ray = random_ray(random);
        ray.origin *= 4.0f;
        caster.find_all(ray, hits);
        const std::optional<RayHit> nearest = caster.nearest(ray);
        REQUIRE(nearest.has_value() == !hits.empty());
        for (std::size_t k = 0; k + 1 < hits.size(); ++k) {
            CHECK(hits[k].t <= hits[k + 1].t);
        }
        if (hits.size() == 2) {
            ++pairs;
            CHECK(nearest->t == hits[0].t);
            CHECK(hits[0].front);
            CHECK_FALSE(hits[1].front);
        }
    }
    CHECK(pairs > 20);
}

TEST_CASE("ray caster: no ray passes between the triangles of a closed mesh") {
    // Rays from the center to vertices and to points on edges, where they are missed most easily.
    const MeshData mesh = make_sphere({.radius = 1, .segments = 48, .rings = 24});
    const RayCaster caster(mesh.positions, mesh.indices);
    for (std::size_t i = 0; i + 3 <= mesh.indices.size(); i += 3) {
        const Vec3& a = mesh.positions[mesh.indices[i]];
        const Vec3& b = mesh.positions[mesh.indices[i + 1]];
        for (const float s : {0.0f, 0.25f, 0.5f, 0.77f}) {
            const Vec3 target = a + s * (b - a);
            CHECK(caster.nearest({.origin = {0.01f, 0.02f, 0}, .direction = target}).has_value());
        }
    }
}

TEST_CASE("ray caster: on an edge the triangle with the lower index counts") {
    const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    const std::vector<std::uint32_t> indices = {1, 3, 2, 0, 1, 2};
    const RayCaster caster(positions, indices);
    const auto hit = caster.nearest({.origin = {0.5f, 0.5f, 1}});
    REQUIRE(hit.has_value());
    CHECK(hit->triangle == 0);
    CHECK(hit->t == 1);
}

TEST_CASE("ray caster: hits begin and end with the ray") {
    const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<std::uint32_t> indices = {0, 1, 2};
    const RayCaster caster(positions, indices);
    const auto hit = [&](float min_t, float max_t) {
        return caster.nearest({.origin = {0.2f, 0.2f, 1}, .min_t = min_t, .max_t = max_t})
            .has_value();
    };
    CHECK(hit(0, 1.001f));
    CHECK_FALSE(hit(0, 0.999f));
    CHECK(hit(0.999f, 2));
    CHECK_FALSE(hit(1.001f, 2));
}

TEST_CASE("ray caster: no triangles, triangles without area and NaN are never hit") {
    const RayCaster empty({}, {});
    CHECK_FALSE(empty.nearest({}).has_value());
    CHECK_FALSE(empty.nearest_point(Vec3(0), 10).has_value());
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, kNan, 0}, {1, 1, 0}};
    const std::vector<std::uint32_t> indices = {0, 1, 2, 0, 0, 0, 0, 1, 3};
    const RayCaster caster(positions, indices);
    CHECK_FALSE(caster.nearest({.origin = {0.1f, 0, 1}}).has_value());
    CHECK_FALSE(caster.nearest({.origin = {0.5f, 0.2f, 1}}).has_value());
}

TEST_CASE("ray caster: the nearest point is that of a search over all triangles") {
    const MeshData mesh = make_two_spheres();
    const RayCaster caster(mesh.positions, mesh.indices);
    std::mt19937 random(11);
    std::uniform_real_distribution<float> place(-2, 2);
    for (int i = 0; i < 40; ++i) {
        const Vec3 p = {place(random), place(random), place(random)};
        // The point of each triangle by a fine grid of barycentric coordinates.
        double best = std::numeric_limits<double>::infinity();
        for (std::size_t t = 0; t + 3 <= mesh.indices.size(); t += 3) {
            constexpr int kGrid = 8;
            for (int a = 0; a <= kGrid; ++a) {
                for (int b = 0; a + b <= kGrid; ++b) {
                    const Vec3 w = Vec3(a, b, kGrid - a - b) / float{kGrid};
                    const Vec3 q = w.x * mesh.positions[mesh.indices[t]]
                                   + w.y * mesh.positions[mesh.indices[t + 1]]
                                   + w.z * mesh.positions[mesh.indices[t + 2]];
                    best = std::min(best, static_cast<double>(glm::length(q - p)));
                }
            }
        }
        const std::optional<RayHit> found = caster.nearest_point(p, 10);
        REQUIRE(found.has_value());
        const Vec3 at = at_hit<Vec3>(*found, mesh.indices, mesh.positions);
        CHECK(std::abs(glm::length(at - p) - found->t) < 1e-5f);
        CHECK(found->t <= best + 1e-6);
        CHECK(found->t >= best - 0.04);  // the grid's spacing
        CHECK_FALSE(caster.nearest_point(p, 0.99f * found->t).has_value());
    }
}

TEST_CASE("ray caster: the number of threads does not change a hit") {
    const MeshData mesh = make_sphere({.radius = 1, .segments = 200, .rings = 100});
    const auto trace = [&](int threads) {
        set_thread_count(threads);
        const RayCaster caster(mesh.positions, mesh.indices);
        std::vector<RayHit> hits;
        for (const Vec3& target : mesh.positions) {  // through vertices: six triangles at each
            hits.push_back(
                caster.nearest({.origin = Vec3(0), .direction = target}).value_or(RayHit{}));
        }
        return hits;
    };
    const int before = thread_count();
    const std::vector<RayHit> one = trace(1);
    const std::vector<RayHit> four = trace(4);
    set_thread_count(before);
    for (std::size_t i = 0; i < one.size(); ++i) {
        CHECK(one[i].triangle == four[i].triangle);
        CHECK(one[i].t == four[i].t);
    }
}

}  // namespace limn::ray_caster_test
