#include "content/bake/skin_texels.h"
#include "content/bake/tangents.h"
#include "content/bake/wrinkle_model.h"
#include "content/make/head/strain_fold_pattern.h"
#include "content/make/models/shapes.h"
#include "ecs/base/rng.h"
#include "systems/faces/skin_strain.h"
#include "systems/faces/wrinkle_measure.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace limn::wrinkle_model_test {
namespace {

using test::near;

/// Uniform in -1 .. 1.
float signed_random(Random& random) {
    return 2 * random.uniform() - 1;
}

Vec3 random_strain(Random& random, float most) {
    return most * Vec3(signed_random(random), signed_random(random), signed_random(random));
}

/// A quadratic without a constant.
Vec2 quadratic(const Vec3& e) {
    return {2 * e.x - e.y + 3 * e.x * e.x + e.y * e.z, 0.5f * e.z - 4 * e.y * e.y + 2 * e.x * e.z};
}

/// Poses of one texel with slopes of f.
template <typename F>
std::vector<WrinklePose> pose_texel(int count, float most, F f) {
    Random random(11, 0, 0, 0);
    std::vector<WrinklePose> poses;
    for (int i = 0; i < count; ++i) {
        const Vec3 strain = random_strain(random, most);
        poses.push_back({{strain}, {f(strain)}});
    }
    return poses;
}

double error_at_poses(const WrinkleModel& model, const std::vector<WrinklePose>& poses) {
    double sum = 0;
    for (const WrinklePose& pose : poses) {
        const Vec2 error = modeled_slope(model, 0, pose.strain[0]) - pose.slopes[0];
        sum += static_cast<double>(glm::dot(error, error));
    }
    return sum;
}

double square_of_slopes(const std::vector<WrinklePose>& poses) {
    double sum = 0;
    for (const WrinklePose& pose : poses) {
        sum += static_cast<double>(glm::dot(pose.slopes[0], pose.slopes[0]));
    }
    return sum;
}

TEST_CASE("wrinkle model: degrees 1, 2 and 3 have 3, 9 and 19 terms besides the constant") {
    CHECK(wrinkle_terms(1) == 3);
    CHECK(wrinkle_terms(2) == 9);
    CHECK(wrinkle_terms(3) == 19);
}

TEST_CASE(
    "wrinkle model: skin at rest is smooth, whatever the poses and the degree"
    * technique("face.wrinkle-model")) {
    for (int degree = 1; degree <= 3; ++degree) {
        const WrinkleModel model = fit_wrinkle_model(
            1, pose_texel(24, 0.2f, [](const Vec3& e) { return quadratic(e) + 0.3f; }),
            {.degree = degree});
        CHECK(modeled_slope(model, 0, Vec3(0)) == Vec2(0));
    }
}

TEST_CASE(
    "wrinkle model: sixteen poses of a quadratic give it back, and of a line at degree 1"
    * technique("face.wrinkle-model")) {
    const auto poses = pose_texel(16, 0.2f, quadratic);
    const WrinkleModel model = fit_wrinkle_model(1, poses, {.degree = 2, .ridge = 1e-9f});
    Random random(12, 0, 0, 0);
    for (int i = 0; i < 50; ++i) {
        const Vec3 strain =
            glm::clamp(random_strain(random, 0.2f), model.min_strain[0], model.max_strain[0]);
        CHECK(glm::distance(modeled_slope(model, 0, strain), quadratic(strain)) < 1e-5f);
    }
    const auto line = [](const Vec3& e) { return Vec2(e.x - 2 * e.z, 3 * e.y); };
    const WrinkleModel linear =
        fit_wrinkle_model(1, pose_texel(4, 0.1f, line), {.degree = 1, .ridge = 1e-9f});
    const Vec3 strain = 0.5f * linear.max_strain[0];
    CHECK(glm::distance(modeled_slope(linear, 0, strain), line(strain)) < 1e-6f);
}

TEST_CASE(
    "wrinkle model: at its poses it is no worse than no wrinkles, and better by degree"
    * technique("face.wrinkle-model")) {
    const auto poses = pose_texel(30, 0.3f, [](const Vec3& e) {
        return Vec2(std::sqrt(std::max(-e.x, 0.0f)), std::sin(20 * e.y) * e.z);
    });
    double previous = square_of_slopes(poses);
    for (int degree = 1; degree <= 3; ++degree) {
        const double error = error_at_poses(fit_wrinkle_model(1, poses, {.degree = degree}), poses);
        CHECK(error < previous);
        previous = error;
    }
    // However few poses, and however strong the ridge.
    for (const int count : {1, 2, 5}) {
        const auto few = pose_texel(count, 0.3f, quadratic);
        for (const float ridge : {1e-4f, 1.0f, 100.0f}) {
            const WrinkleModel model = fit_wrinkle_model(1, few, {.degree = 3, .ridge = ridge});
            CHECK(error_at_poses(model, few) <= square_of_slopes(few));
        }
    }
}

TEST_CASE(
    "wrinkle model: strain beyond the poses counts as the nearest within them"
    * technique("face.wrinkle-model")) {
    const auto poses = pose_texel(16, 0.2f, quadratic);
    const WrinkleModel model = fit_wrinkle_model(1, poses, {.degree = 2, .ridge = 1e-9f});
    const Vec3 beyond = {1, -1, 1};
    const Vec3 nearest = {model.max_strain[0].x, model.min_strain[0].y, model.max_strain[0].z};
    CHECK(modeled_slope(model, 0, beyond) == modeled_slope(model, 0, nearest));
    CHECK(glm::length(modeled_slope(model, 0, beyond)) < 3.0f);
    // A texel without strain in every pose has no wrinkles at any strain.
    const WrinkleModel still =
        fit_wrinkle_model(1, std::vector<WrinklePose>(5, {{Vec3(0)}, {Vec2(0)}}), {});
    CHECK(modeled_slope(still, 0, beyond) == Vec2(0));
}

TEST_CASE("wrinkle model: a texel whose pose is not finite has no wrinkles, others keep theirs") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::vector<WrinklePose> poses;
    for (const WrinklePose& one : pose_texel(16, 0.2f, quadratic)) {
        poses.push_back({std::vector<Vec3>(4, one.strain[0]), std::vector<Vec2>(4, one.slopes[0])});
    }
    poses[3].strain[1].y = nan;
    poses[5].slopes[2].x = nan;
    const WrinkleModel model = fit_wrinkle_model(2, poses, {});
    const Vec3 strain = 0.5f * model.max_strain[0];
    CHECK(glm::length(modeled_slope(model, 0, strain)) > 0.01f);
    CHECK(modeled_slope(model, 1, strain) == Vec2(0));
    CHECK(modeled_slope(model, 2, strain) == Vec2(0));
    CHECK(modeled_slope(model, 3, strain) == modeled_slope(model, 0, strain));
}

TEST_CASE("wrinkle model: packed, it is tiles of the ranges and of two terms each") {
    const auto poses = pose_texel(30, 0.2f, quadratic);
    for (const int degree : {1, 2, 3}) {
        const WrinkleModel model = fit_wrinkle_model(1, poses, {.degree = degree});
        const ImageData image = pack_wrinkle_model(model);
        const int terms = wrinkle_terms(degree);
        CHECK(image.width == 1);
        CHECK(image.height == 2 + (terms + 1) / 2);
        CHECK(image.pixels.size() == 8 * static_cast<std::size_t>(image.height));
        const auto tile = [&](int index) {
            std::uint64_t bits = 0;
            std::memcpy(&bits, &image.pixels[8 * static_cast<std::size_t>(index)], 8);
            return glm::unpackHalf4x16(bits);
        };
        CHECK(tile(0).x == near(model.min_strain[0].x).epsilon(1e-3));
        CHECK(tile(0).w == near(model.max_strain[0].y).epsilon(1e-3));
        CHECK(tile(1).y == near(model.max_strain[0].z).epsilon(1e-3));
        const Vec2 last = model.coefficients[static_cast<std::size_t>(terms - 1)];
        CHECK(tile(image.height - 1).x == near(last.x).scale(1).epsilon(1e-4));
        CHECK(tile(2).z == near(model.coefficients[1].x).epsilon(1e-3));
    }
}

/// A bent sheet with slanted triangles, and a deformed one.
MeshData make_bent() {
    MeshData mesh = make_sphere({.radius = 1, .segments = 24, .rings = 12});
    generate_tangents(mesh);
    return mesh;
}

TEST_CASE(
    "skin texels: the strain is that of the wrinkle driver, where it is small"
    * technique("face.wrinkle-model")) {
    const MeshData mesh = make_bent();
    std::vector<Vec3> deformed = mesh.positions;
    for (Vec3& p : deformed) {
        p += 0.02f * Vec3(std::sin(2 * p.y), p.x * p.z, std::cos(3 * p.x));
    }
    const std::vector<Vec3> found = find_tangent_strain(mesh, deformed);
    const SkinTriangles skin = make_skin_triangles(mesh.positions, mesh.indices, 0);
    std::vector<Vec3> normals;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        normals.push_back(glm::cross(skin.vertex_u[v], skin.vertex_v[v]));
    }
    const auto rests = make_strain_rest(mesh.positions, mesh.indices, skin.vertex_u, normals);
    std::array<std::vector<float>, 3> lengths;
    for (std::size_t i = 0; i < 3; ++i) {
        lengths[i] = vertex_compression({&rests[i], 1}, deformed);
    }
    float largest = 0;
    for (std::size_t v = 0; v < found.size(); ++v) {
        if (std::abs(mesh.positions[v].y) > 0.98f) {
            continue;  // poles: tangents differ at one position
        }
        const Vec3 t = mesh.tangents[v];
        const float angle =
            std::atan2(glm::dot(t, skin.vertex_v[v]), glm::dot(t, skin.vertex_u[v]));
        const SkinStrain expected = strain_of_tensor(
            tensor_of_ratios(lengths[0][v], lengths[1][v], lengths[2][v]), angle,
            mesh.tangents[v].w < 0 ? -1.0f : 1.0f);
        const Vec3 exact = {expected.uu, expected.vv, expected.uv};
        CHECK(glm::distance(found[v], exact) < 2e-4f);
        largest = std::max(largest, glm::length(exact));
    }
    CHECK(largest > 0.02f);
}

TEST_CASE("skin texels: rigid motion has no strain, and stretch along the tangent is its strain") {
    const MeshData mesh = make_bent();
    std::vector<Vec3> turned;
    for (const Vec3& p : mesh.positions) {
        turned.emplace_back(p.z + 1, p.x, p.y - 2);
    }
    for (const Vec3& strain : find_tangent_strain(mesh, turned)) {
        CHECK(glm::length(strain) < 1e-5f);
    }
    MeshData square;
    square.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    square.normals.assign(4, Vec3(0, 0, 1));
    square.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    square.indices = {0, 1, 2, 0, 2, 3};
    generate_tangents(square);
    const std::vector<Vec3> wider = {{0, 0, 0}, {0.8f, 0, 0}, {0.8f, 1.05f, 0}, {0, 1.05f, 0}};
    for (const Vec3& strain : find_tangent_strain(square, wider)) {
        CHECK(glm::distance(strain, Vec3(-0.2f, 0.05f, 0)) < 1e-5f);
    }
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Vec3& strain : find_tangent_strain(square, std::vector<Vec3>(4, Vec3(nan)))) {
        CHECK(strain == Vec3(0));
    }
}

TEST_CASE("skin texels: centers of texels lie on the triangles of the mesh, and a gutter grows") {
    MeshData mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.uvs = {{0.25f, 0.25f}, {0.75f, 0.25f}, {0.25f, 0.75f}};
    mesh.indices = {0, 1, 2};
    const std::vector<SkinTexel> texels = find_skin_texels(mesh, 16, 0);
    int covered = 0;
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x) {
            const SkinTexel& texel = texels[static_cast<std::size_t>(16 * y + x)];
            const Vec2 uv = (Vec2(x, y) + 0.5f) / 16.0f;
            const bool inside = uv.x >= 0.25f && uv.y >= 0.25f && uv.x + uv.y <= 1.0f;
            CHECK((texel.triangle == 0) == inside);
            if (inside) {
                const Vec2 at = at_texel(mesh.indices, texel, std::span<const Vec2>(mesh.uvs));
                CHECK(glm::distance(at, uv) < 1e-6f);
                ++covered;
            }
        }
    }
    int wider = 0;
    for (const SkinTexel& texel : find_skin_texels(mesh, 16, 1)) {
        wider += texel.triangle >= 0 ? 1 : 0;
    }
    CHECK(wider > covered + 16);
    CHECK(texels[0].triangle == -1);
}

TEST_CASE("strain folds: of a head they are smooth at rest and steep where it frowns") {
    const PatternMaps maps = make_strain_folds({.size = 96, .degree = 1});
    CHECK(maps.normal.format == PixelFormat::Rgba16F);
    CHECK(maps.normal.width == 96);
    CHECK(maps.normal.height == 4 * 96);
    int coefficients = 0;
    for (std::size_t i = 2 * 96 * 96 * 8; i + 8 <= maps.normal.pixels.size(); i += 8) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &maps.normal.pixels[i], 8);
        const Vec4 c = glm::unpackHalf4x16(bits);
        CHECK_UNARY(std::isfinite(c.x + c.y + c.z + c.w));
        coefficients += glm::length(c) > 0.05f ? 1 : 0;
    }
    CHECK(coefficients > 100);
}

}  // namespace
}  // namespace limn::wrinkle_model_test
