#pragma once

#include "bench/fakephong/phong_raster.h"
#include "ecs/components/rendering.h"
#include "tests/render/scene_fixture.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>
#include <string>

namespace limn::test {

// One scene, drawn by the renderer and by the rasterizer of the fake-Phong laboratory.

inline constexpr int kSide = 128;

struct NamedRate {
    ShadingRate rate;
    const char* method;  ///< of the laboratory
};
inline constexpr NamedRate kRates[] = {
    {ShadingRate::Pixel, "phong"},
    {ShadingRate::Vertex, "gouraud"},
    {ShadingRate::Subdivided, "gouraud-subdivided"},
    {ShadingRate::Quadratic, "quadratic"},
    {ShadingRate::Cubic, "cubic"},
    {ShadingRate::NormalsQuadratic, "normals-quadratic"},
    {ShadingRate::NormalsSpherical, "normals-spherical"},
    {ShadingRate::Taylor, "taylor"},
    {ShadingRate::BlinnMap, "blinn-map"},
    {ShadingRate::QuadraticBlinn, "quadratic-blinn"},
    {ShadingRate::PhongMap, "phong-map"},
    {ShadingRate::Environment, "envmap"},
    {ShadingRate::HwBlinn, "hw-blinn"},
    {ShadingRate::HwQuadratic, "hw-quadratic"}};
inline constexpr float kStep = 1.0f / 255;

/// The same scene for the renderer and for the rasterizer of the laboratory.
class Laboratory : public Scene {
  public:
    static constexpr Vec3 kDiffuse = {0.5f, 0.4f, 0.3f};
    Vec3 eye = {0.4f, 0.5f, 3};
    fakephong::PhongScene laboratory = {
        .material =
            {.color = glm::dvec3(kDiffuse),
             .ambient = 0,
             .diffuse = 1,
             .specular = 0.4,
             .exponent = 20},
        .camera = {.eye = glm::dvec3(eye), .half_size = 1, .size = kSide},
        .channels = fakephong::Channels::Full,
        .environment_exponent = 5};
    MaterialId shiny = add(Material{
        .shading = ShadingModel::Blinn,
        .base_color = Vec4(kDiffuse, 1),
        .specular = Vec3(0.4f),
        .shininess = 20});
    Entity object = {};
    Rendering rendering = {};

    void show(const MeshData& mesh) {
        laboratory.mesh = {};
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            laboratory.mesh.positions.emplace_back(mesh.positions[i]);
            laboratory.mesh.normals.emplace_back(mesh.normals[i]);
        }
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            laboratory.mesh.triangles.push_back(
                {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
        }
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
        rendering.shading = rate;
        world.insert_resource(rendering);
        return radiance(look(eye, {0, 0, 0}, kSide, kSide));
    }
    /// Of the colors by either, over pixels that a triangle covers with all their neighbors.
    float largest_distance(const NamedRate& named) {
        const gpu::FloatImage ours = drawn(named.rate);
        const auto lab = fakephong::draw(laboratory, *fakephong::find_method(named.method));
        float largest = 0;
        int compared = 0;
        for (int y = 1; y + 1 < kSide; ++y) {
            for (int x = 1; x + 1 < kSide; ++x) {
                if (is_inside(lab, x, y)) {
                    const auto pixel = static_cast<std::size_t>(y) * kSide + x;
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
    void compare_all(float hw_quadratic_bound = kStep) {
        for (const NamedRate& named : kRates) {
            // One light has all that appendix B has; the laboratory gives it more.
            const bool hw_quadratic = named.rate == ShadingRate::HwQuadratic;
            rendering.hardware.first_light = hw_quadratic;
            const float bound = hw_quadratic ? hw_quadratic_bound : kStep;
            CHECK_MESSAGE(largest_distance(named) < bound, std::string(named.method));
        }
    }

  private:
    /// Whether it and its neighbors are covered.
    static bool is_inside(const fakephong::PhongImage& image, int x, int y) {
        for (int dy = -1; dy <= 1; ++dy) {
            for (int dx = -1; dx <= 1; ++dx) {
                if (image.mask[static_cast<std::size_t>(y + dy) * kSide + (x + dx)] == 0) {
                    return false;
                }
            }
        }
        return true;
    }
};

/// One large triangle whose normals spread; its centroid is the center of its box.
inline MeshData make_spread_triangle() {
    MeshData mesh;
    mesh.positions = {{-1.5f, 0, 0}, {0, -1.5f, 0}, {1.5f, 1.5f, 0}};
    mesh.tangents.assign(3, {1, 0, 0, 1});
    mesh.uvs = {{0, 0.5f}, {0.5f, 1}, {1, 0}};
    mesh.indices = {0, 1, 2};
    for (const Vec3& p : mesh.positions) {
        mesh.normals.push_back(glm::normalize(Vec3(0, 0, 1) + 0.5f * p));
        grow(mesh.bounds, p);
    }
    return mesh;
}

}  // namespace limn::test
