#include "bench/oracles/light_oracle.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

namespace limn::test::lighting_space_test {
namespace {

// shade.lighting-space: the same light in the object's, the world's and the camera's space. Limn
// lights in the world's; the other two are written down here, in double precision, with every
// product of a matrix and a vector counted.

using oracle::DVec3;
using DMat4 = glm::dmat4;

struct Moved {
    DMat4 world_from_object{1.0};
    DMat4 view_from_world{1.0};
    DVec3 light;   // world
    DVec3 camera;  // world
    int products = 0;

    DVec3 point(const DMat4& m, const DVec3& p) {
        ++products;
        return m * glm::dvec4(p, 1.0);
    }
    DVec3 normal(const DMat4& m, const DVec3& n) {
        ++products;
        return glm::normalize(glm::transpose(glm::inverse(glm::dmat3(m))) * n);
    }
};

const oracle::ClassicMaterial kMaterial = {
    .ambient = DVec3(0), .diffuse = DVec3(0.6), .specular = DVec3(0.3), .shininess = 20};

/// All in one space; the light's color does not fade.
double shade(const DVec3& p, const DVec3& n, const DVec3& light, const DVec3& camera) {
    const oracle::Arriving arriving = {glm::normalize(light - p), DVec3(1)};
    return oracle::blinn(
               kMaterial, DVec3(0), std::span(&arriving, 1), n, glm::normalize(camera - p))
        .x;
}

struct Vertex {
    DVec3 position;
    DVec3 normal;
};

std::vector<double> shade_in_object(Moved& m, std::span<const Vertex> vertices) {
    const DMat4 object_from_world = glm::inverse(m.world_from_object);
    const DVec3 light = m.point(object_from_world, m.light);
    const DVec3 camera = m.point(object_from_world, m.camera);
    std::vector<double> result;
    for (const Vertex& v : vertices) {
        result.push_back(shade(v.position, v.normal, light, camera));
    }
    return result;
}

std::vector<double> shade_in_world(Moved& m, std::span<const Vertex> vertices) {
    std::vector<double> result;
    for (const Vertex& v : vertices) {
        const DVec3 p = m.point(m.world_from_object, v.position);
        result.push_back(shade(p, m.normal(m.world_from_object, v.normal), m.light, m.camera));
    }
    return result;
}

std::vector<double> shade_in_view(Moved& m, std::span<const Vertex> vertices) {
    const DMat4 view_from_object = m.view_from_world * m.world_from_object;
    const DVec3 light = m.point(m.view_from_world, m.light);
    std::vector<double> result;
    for (const Vertex& v : vertices) {
        const DVec3 p = m.point(view_from_object, v.position);
        result.push_back(shade(p, m.normal(view_from_object, v.normal), light, DVec3(0)));
    }
    return result;
}

}  // namespace

TEST_CASE_FIXTURE(
    Scene, "lighting space: object, world and view space give the drawn image, by as many products"
               * technique("shade.lighting-space")) {
    // A square, rotated and moved; the center pixel shows its center.
    const Quat turn = glm::angleAxis(0.6f, glm::normalize(Vec3(1, 2, 0.5f)));
    const Vec3 center_ws = {0.4f, -0.3f, 0.2f};
    const MaterialId material = add(Material{
        .shading = ShadingModel::Blinn,
        .base_color = {0.6f, 0.6f, 0.6f, 1},
        .specular = {0.3f, 0.3f, 0.3f},
        .shininess = 20});
    place(
        add(make_square()), material,
        affine_from(center_ws, {turn.w, turn.x, turn.y, turn.z}, {1, 1, 1}));
    const Vec3 lamp = {1.2f, 0.8f, 2.2f};
    shine(
        PointLight{.intensity = kPi, .radius = 1000, .attenuation = {.falloff = Falloff::None}},
        at(lamp));
    const Vec3 eye = {0.9f, 0.4f, 2};
    const RenderView view = look(eye, center_ws, 65, 65);

    Moved moved;
    moved.world_from_object =
        glm::translate(DMat4(1.0), DVec3(center_ws)) * glm::mat4_cast(glm::dquat(turn));
    moved.view_from_world = glm::lookAt(DVec3(eye), DVec3(center_ws), DVec3(0, 1, 0));
    moved.light = lamp;
    moved.camera = eye;
    const Vertex vertices[] = {
        {{0, 0, 0}, {0, 0, 1}}, {{-1, -1, 0}, {0, 0, 1}}, {{1, 0.5, 0}, {0, 0, 1}}};

    const std::vector<double> in_object = shade_in_object(moved, vertices);
    CHECK(moved.products == 2);  // once an object
    moved.products = 0;
    const std::vector<double> in_world = shade_in_world(moved, vertices);
    CHECK(moved.products == 2 * 3);  // twice a vertex
    moved.products = 0;
    const std::vector<double> in_view = shade_in_view(moved, vertices);
    CHECK(moved.products == 2 * 3 + 1);  // and the light once
    for (std::size_t i = 0; i < std::size(vertices); ++i) {
        CHECK(in_world[i] > 0.05);
        CHECK(std::abs(in_object[i] - in_world[i]) < 1e-5);
        CHECK(std::abs(in_view[i] - in_world[i]) < 1e-5);
    }
    CHECK(rgb_at(radiance(view), 32, 32).x == test::near(in_world[0]).epsilon(2e-3));
}

TEST_CASE_FIXTURE(
    Scene, "lighting space: normals of a stretched plane use the inverse transpose"
               * technique("shade.lighting-space")) {
    // The plane x + y = 0, its normal (1, 1, 0) / sqrt 2, twice as long along x.
    MeshData plane = make_square();
    const float r = std::sqrt(0.5f);
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3 p = plane.positions[i];
        plane.positions[i] = {-r * p.x, r * p.x, p.y};
        plane.normals[i] = {r, r, 0};
        plane.tangents[i] = {-r, r, 0, 1};
    }
    plane.bounds = {{-1, -1, -1}, {1, 1, 1}};
    place(
        add(std::move(plane)), add(Material{.double_sided = true}),
        affine_from({0, 0, 0}, {1, 0, 0, 0}, {2, 1, 1}));
    const gpu::FloatImage normal = aov(look({1, 2, 0}, {0, 0, 0}), "normal");
    CHECK(glm::distance(rgb_at(normal, 32, 32), Vec3(0.4472f, 0.8944f, 0)) < 1e-3f);
    // The matrix itself would rotate it in the wrong direction.
    CHECK(glm::distance(glm::normalize(Vec3(2 * r, r, 0)), Vec3(0.8944f, 0.4472f, 0)) < 1e-4f);
}

TEST_CASE_FIXTURE(
    Scene, "lighting space: distances to lights are in meters, however an object is scaled"
               * technique("shade.lighting-space")) {
    // Polynomial (1, 0.7, 1.8) at 2 m: 0.1042 of the light; at 1 m, as an object of scale 2 would
    // have it, 0.2857.
    const MaterialId matte = add(Material{
        .shading = ShadingModel::Blinn, .base_color = {1, 1, 1, 1}, .specular = {0, 0, 0}});
    const Entity square = place(add(make_square()), matte, at({0, 0, 0}));
    shine(
        PointLight{
            .intensity = kPi,
            .radius = 0,
            .attenuation =
                {.falloff = Falloff::Polynomial, .constant = 1, .linear = 0.7f, .quadratic = 1.8f}},
        at({0, 0, 2}));
    for (const float scale : {1.0f, 2.0f, 5.0f}) {
        world.get<WorldTransform>(square).world = affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(scale));
        const gpu::FloatImage image = radiance(look({0, 0, 0.5f}, {0, 0, 0}, 65, 65));
        CHECK(image.at(32, 32, 0) == test::near(0.1042).epsilon(2e-3));
    }
}

}  // namespace limn::test::lighting_space_test
