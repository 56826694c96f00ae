#include "bench/fakephong/phong_models.h"
#include "bench/fakephong/phong_raster.h"
#include "ecs/components/rendering.h"
#include "tests/render/scene_fixture.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>
#include <string>

namespace limn::test {
namespace {

constexpr int kSide = 128;

struct NamedRate {
    ShadingRate rate;
    const char* method;  ///< of the laboratory
};
constexpr NamedRate kRates[] = {
    {ShadingRate::Pixel, "phong"},
    {ShadingRate::Vertex, "gouraud"},
    {ShadingRate::Subdivided, "gouraud-subdivided"},
    {ShadingRate::Quadratic, "quadratic"},
    {ShadingRate::Cubic, "cubic"},
    {ShadingRate::NormalsQuadratic, "normals-quadratic"},
    {ShadingRate::NormalsSpherical, "normals-spherical"}};

/// The same scene for the renderer and for the rasterizer of the laboratory.
class SampledShading : public Scene {
  public:
    static constexpr Vec3 kDiffuse = {0.5f, 0.4f, 0.3f};
    static constexpr Vec3 kEye = {0.4f, 0.5f, 3};
    fakephong::PhongScene laboratory = {
        .material =
            {.color = glm::dvec3(kDiffuse),
             .ambient = 0,
             .diffuse = 1,
             .specular = 0.4,
             .exponent = 20},
        .camera = {.eye = glm::dvec3(kEye), .half_size = 1, .size = kSide},
        .channels = fakephong::Channels::Full};
    MaterialId shiny = add(Material{
        .shading = ShadingModel::Blinn,
        .base_color = Vec4(kDiffuse, 1),
        .specular = Vec3(0.4f),
        .shininess = 20});
    Entity object = {};

    void show(const MeshData& mesh) {
        laboratory.mesh = fakephong::phong_mesh(mesh);
        object = place(add(mesh), shiny, at({0, 0, 0}));
    }
    /// What arrives from each is 1, whatever the distance.
    void point_light(const Vec3& position) {
        shine(
            PointLight{.intensity = kPi, .radius = 1000, .attenuation = {.falloff = Falloff::None}},
            at(position));
        laboratory.lights.push_back({.at = glm::dvec3(position)});
    }
    void directional_light(const Vec3& to_light) {
        shine(DirectionalLight{.illuminance = kPi}, look_at({0, 0, 0}, -to_light));
        laboratory.lights.push_back({.directional = true, .at = glm::dvec3(to_light)});
    }
    gpu::FloatImage drawn(ShadingRate rate) {
        world.insert_resource(Rendering{.shading = rate});
        return radiance(look(kEye, {0, 0, 0}, kSide, kSide));
    }
    /// Of the colors by either, over pixels that a triangle covers with all their neighbors.
    float largest_distance(const NamedRate& named) {
        const gpu::FloatImage ours = drawn(named.rate);
        const auto lab = fakephong::draw(laboratory, *fakephong::find_method(named.method));
        float largest = 0;
        int compared = 0;
        for (int y = 1; y + 1 < kSide; ++y) {
            for (int x = 1; x + 1 < kSide; ++x) {
                const auto pixel = static_cast<std::size_t>(y) * kSide + x;
                bool inside = true;
                for (int dy = -1; dy <= 1; ++dy) {
                    for (int dx = -1; dx <= 1; ++dx) {
                        const auto near = static_cast<std::size_t>(y + dy) * kSide + (x + dx);
                        inside = inside && lab.mask[near] != 0;
                    }
                }
                if (inside) {
                    const Vec3 d =
                        glm::abs(glm::min(rgb_at(ours, x, y), Vec3(1)) - lab.color.pixels[pixel]);
                    largest = std::max({largest, d.x, d.y, d.z});
                    ++compared;
                }
            }
        }
        CHECK(compared > 500);
        return largest;
    }
    void compare_all() {
        for (const NamedRate& named : kRates) {
            CHECK_MESSAGE(largest_distance(named) < 1.0f / 255, std::string(named.method));
        }
    }
};

/// One large triangle whose normals spread.
MeshData make_spread_triangle() {
    MeshData mesh = make_square();
    for (Vec3& n : mesh.normals) {
        n = glm::normalize(Vec3(0, 0, 1) + 0.4f * mesh.positions[&n - mesh.normals.data()]);
    }
    mesh.indices = {0, 1, 2};
    return mesh;
}

/// Each triangle in four, at midpoints with the normalized sum of the normals.
MeshData subdivide(const MeshData& mesh) {
    MeshData result = mesh;
    result.indices.clear();
    const auto middle = [&result](std::uint32_t a, std::uint32_t b) {
        result.positions.push_back(0.5f * (result.positions[a] + result.positions[b]));
        result.normals.push_back(glm::normalize(result.normals[a] + result.normals[b]));
        result.tangents.push_back(result.tangents[a]);
        result.uvs.push_back(0.5f * (result.uvs[a] + result.uvs[b]));
        return static_cast<std::uint32_t>(result.positions.size() - 1);
    };
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const std::uint32_t a = mesh.indices[i];
        const std::uint32_t b = mesh.indices[i + 1];
        const std::uint32_t c = mesh.indices[i + 2];
        const std::uint32_t ab = middle(a, b);
        const std::uint32_t bc = middle(b, c);
        const std::uint32_t ca = middle(c, a);
        result.indices.insert(result.indices.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
    }
    return result;
}

}  // namespace

TEST_CASE_FIXTURE(
    SampledShading, "shading rates: a triangle is as the laboratory draws it, to within 1/255") {
    show(make_spread_triangle());
    point_light({0.3f, 0.2f, 1.2f});
    compare_all();
}

TEST_CASE_FIXTURE(
    SampledShading, "shading rates: a coarse ball under three lights is as the laboratory has it") {
    show(make_ball(8));
    point_light({0.6f, 1.5f, 3});
    point_light({-1, -0.5f, 3});
    directional_light({0.2f, 0.4f, 1});
    compare_all();
}

TEST_CASE_FIXTURE(
    SampledShading,
    "shading rates: subdivided is per vertex on a mesh of four times the triangles") {
    const MeshData ball = make_ball(6);
    show(ball);
    point_light({0.6f, 0.9f, 2.5f});
    const gpu::FloatImage subdivided = drawn(ShadingRate::Subdivided);
    const gpu::FloatImage coarse = drawn(ShadingRate::Vertex);
    world.get<MeshInstance>(object).mesh = add(subdivide(ball));
    const gpu::FloatImage fine = drawn(ShadingRate::Vertex);
    CHECK(largest_difference(subdivided, fine) < 2e-3f);
    CHECK(largest_difference(coarse, fine) > 0.02f);
}

TEST_CASE_FIXTURE(
    SampledShading,
    "shading rates: normals that cancel at a midpoint give way to that of the face") {
    MeshData mesh = make_square();
    mesh.normals = {{1, 0, 0}, {-1, 0, 0}, {0, 0.6f, 0.8f}, {0, 0, 1}};
    mesh.indices = {0, 1, 2};
    show(mesh);
    directional_light({0.1f, 0.2f, 1});
    compare_all();
}

}  // namespace limn::test
