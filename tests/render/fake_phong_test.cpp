#include "render/light/highlight_layers.h"
#include "tests/near.h"
#include "tests/render/laboratory_fixture.h"
#include "tests/technique.h"

#include <cmath>
#include <utility>
#include <vector>

namespace limn::test::fake_phong_test {
namespace {

bool is_all_finite(const gpu::FloatImage& image) {
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const Vec3 c = rgb_at(image, x, y);
            if (!(std::isfinite(c.x + c.y + c.z) && std::min({c.x, c.y, c.z}) >= 0)) {
                return false;
            }
        }
    }
    return true;
}

bool is_covered_around(const gpu::FloatImage& image, int x, int y) {
    for (int n = 0; n < 9; ++n) {
        if (image.at(x + n % 3 - 1, y + n / 3 - 1, 3) == 0) {
            return false;
        }
    }
    return true;
}

/// Of the light; surfaces are where they are in `b`.
gpu::FloatImage sum(const gpu::FloatImage& a, gpu::FloatImage b) {
    for (std::size_t i = 0; i < b.pixels.size(); ++i) {
        b.pixels[i] += i % 4 == 3 ? 0 : a.pixels[i];
    }
    return b;
}

constexpr Vec3 kAround[] = {{0.2f, 0.4f, 1},   {-0.5f, 0.1f, 1},  {0.1f, -0.6f, 1},
                            {0.7f, 0, 1},      {-0.3f, -0.3f, 1}, {0.4f, 0.6f, 1},
                            {0, 0.1f, 1},      {-0.7f, 0.5f, 1},  {0.6f, -0.5f, 1},
                            {-0.1f, -0.9f, 1}, {0.3f, -0.2f, 1},  {-0.8f, -0.1f, 1}};

}  // namespace

TEST_CASE_FIXTURE(Laboratory, "fake phong: eight lights match the laboratory") {
    show(make_ball(5));
    for (int i = 0; i < 8; ++i) {
        directional_light(kAround[i]);
        laboratory.lights.back().color = glm::dvec3(0.125);
    }
    world.query<DirectionalLight>().each(
        [](DirectionalLight& light) { light.illuminance = kPi / 8; });
    compare_all();
}

TEST_CASE_FIXTURE(
    Laboratory, "fake phong: eight of twelve lights have separate terms, the others are per vertex"
                    * technique("fakephong.blinn-map")) {
    show(make_ball(5));
    std::vector<Entity> lights;
    for (const Vec3& to_light : kAround) {
        lights.push_back(
            shine(DirectionalLight{.illuminance = 0.3f}, look_at({0, 0, 0}, -to_light)));
    }
    const auto only = [&](std::size_t first, std::size_t end, ShadingRate rate) {
        for (std::size_t i = 0; i < lights.size(); ++i) {
            world.get<DirectionalLight>(lights[i]).enabled = i >= first && i < end;
        }
        return drawn(rate);
    };
    const gpu::FloatImage others = only(8, 12, ShadingRate::Vertex);
    for (const ShadingRate rate :
         {ShadingRate::Taylor, ShadingRate::BlinnMap, ShadingRate::QuadraticBlinn}) {
        const gpu::FloatImage first = only(0, 8, rate);
        CHECK(largest_difference(only(0, 12, rate), sum(first, others)) < 1e-3f);
        CHECK(largest_difference(first, only(0, 8, ShadingRate::Vertex)) > 0.02f);
    }
}

TEST_CASE_FIXTURE(Laboratory, "fake phong: a base color map tints everything but highlights") {
    world.resource<Assets>().materials[shiny.index].base_color_texture.image =
        add(ImageData{.name = "magenta", .width = 1, .height = 1, .pixels = {255, 0, 255, 255}});
    laboratory.material.color *= glm::dvec3(1, 0, 1);
    show(make_spread_triangle());
    point_light({0.3f, 0.2f, 2});
    compare_all();
}

TEST_CASE_FIXTURE(
    Laboratory, "fake phong: with each axis a Blinn map matches the laboratory"
                    * technique("fakephong.blinn-axis")) {
    show(make_ball(5));
    point_light({0.6f, 1.5f, 3});
    constexpr fakephong::BlinnAxis kTheirs[] = {
        fakephong::BlinnAxis::CameraUp, fakephong::BlinnAxis::WorldUp,
        fakephong::BlinnAxis::WorstCase, fakephong::BlinnAxis::Custom};
    std::vector<gpu::FloatImage> images;
    rendering.blinn_vector = {3, -1, 0.5f};
    laboratory.axis_vector = {3, -1, 0.5};
    for (int axis = 0; axis < 4; ++axis) {
        rendering.blinn_axis = static_cast<BlinnAxis>(axis);
        laboratory.axis = kTheirs[axis];
        CHECK(largest_distance({ShadingRate::BlinnMap, "blinn-map"}) < kStep);
        CHECK(largest_distance({ShadingRate::QuadraticBlinn, "quadratic-blinn"}) < kStep);
        CHECK(largest_distance({ShadingRate::PhongMap, "phong-map"}) < kStep);
        images.push_back(drawn(ShadingRate::BlinnMap));
    }
    CHECK(largest_difference(images[0], images[2]) > 0.05f);
    CHECK(largest_difference(images[0], images[3]) > kStep);
    // A multiple of the world's up is that; none at all leaves the camera's right.
    rendering.blinn_vector = {0, 7, 0};
    CHECK(largest_difference(drawn(ShadingRate::BlinnMap), images[1]) < 1e-5f);
    rendering.hardware.world_up = false;  // but not its length, which the projected axis keeps
    const gpu::FloatImage long_axis = drawn(ShadingRate::HwBlinn);
    rendering.blinn_axis = BlinnAxis::WorldUp;
    CHECK(largest_difference(drawn(ShadingRate::HwBlinn), long_axis) < 1e-5f);
    rendering.blinn_axis = BlinnAxis::Custom;
    rendering.blinn_vector = {0, 0, 0};
    laboratory.axis_vector = {0, 0, 0};
    CHECK(largest_distance({ShadingRate::BlinnMap, "blinn-map"}) < kStep);
}

TEST_CASE_FIXTURE(
    Laboratory, "fake phong: diffuse light from a Blinn texture matches the laboratory"
                    * technique("fakephong.blinn-map")) {
    show(make_ball(5));
    point_light({0.6f, 1.5f, 3});
    directional_light({-0.5f, 0.1f, 1});
    laboratory.lights[0].color = laboratory.lights[1].color = glm::dvec3(0.5);
    world.query<PointLight>().each([](PointLight& light) { light.intensity = kPi / 2; });
    world.query<DirectionalLight>().each(
        [](DirectionalLight& light) { light.illuminance = kPi / 2; });
    for (const NamedRate& named :
         {NamedRate{ShadingRate::BlinnMap, "blinn-map"},
          NamedRate{ShadingRate::QuadraticBlinn, "quadratic-blinn"}}) {
        rendering.blinn_diffuse = laboratory.diffuse_texture = false;
        const gpu::FloatImage per_vertex = drawn(named.rate);
        rendering.blinn_diffuse = laboratory.diffuse_texture = true;
        CHECK_MESSAGE(largest_distance(named) < kStep, std::string(named.method));
        CHECK(largest_difference(drawn(named.rate), per_vertex) > 0.02f);
    }
    const gpu::FloatImage hardware = drawn(ShadingRate::HwBlinn);  // which has none
    rendering.blinn_diffuse = false;
    CHECK(largest_difference(drawn(ShadingRate::HwBlinn), hardware) == 0);
}

TEST_CASE_FIXTURE(
    Laboratory, "fake phong: four of seven lights have diffuse terms, the others are per vertex") {
    show(make_ball(5));
    rendering.blinn_diffuse = true;
    std::vector<Entity> lights;
    for (int i = 0; i < 7; ++i) {
        lights.push_back(
            shine(DirectionalLight{.illuminance = 0.3f}, look_at({0, 0, 0}, -kAround[i])));
    }
    const auto only = [&](std::size_t first, std::size_t end, ShadingRate rate) {
        for (std::size_t i = 0; i < lights.size(); ++i) {
            world.get<DirectionalLight>(lights[i]).enabled = i >= first && i < end;
        }
        return drawn(rate);
    };
    const gpu::FloatImage others = only(4, 7, ShadingRate::Vertex);
    for (const ShadingRate rate : {ShadingRate::BlinnMap, ShadingRate::QuadraticBlinn}) {
        const gpu::FloatImage first = only(0, 4, rate);
        CHECK(largest_difference(only(0, 7, rate), sum(first, others)) < 1e-3f);
        CHECK(largest_difference(sum(only(0, 2, rate), only(2, 4, rate)), first) < 1e-3f);
    }
}

TEST_CASE_FIXTURE(
    Laboratory, "fake phong: without the perspective divide methods match the laboratory"
                    * technique("fakephong.texmap")) {
    show(make_spread_triangle());
    // The triangle leans away, within the image: Mesa 22.3 clips at its border with perspective.
    eye = {1.4f, 0.9f, 2.1f};
    laboratory.camera.eye = glm::dvec3(eye);
    point_light({0.3f, 0.2f, 2});
    const gpu::FloatImage right = drawn(ShadingRate::Quadratic);
    rendering.screen_interpolation = true;
    laboratory.interpolation = fakephong::Interpolation::Screen;
    for (const NamedRate& named : kRates) {
        if (named.rate != ShadingRate::Pixel) {  // which has positions from the depth
            rendering.hardware.first_light = named.rate == ShadingRate::HwQuadratic;
            CHECK_MESSAGE(largest_distance(named) < kStep, std::string(named.method));
        }
    }
    CHECK(largest_difference(drawn(ShadingRate::Quadratic), right) > 0.02f);
}

TEST_CASE_FIXTURE(
    Laboratory, "fake phong: without the perspective divide a texture is linear on the screen"
                    * technique("fakephong.texmap")) {
    // Along the lower edge w grows from 1 to 3 and u from 0 to 1; the left half of the texture is
    // black. In perspective that is up to a half of u, at 3/4 of the edge on the screen.
    std::vector<std::uint8_t> pixels;
    for (int x = 0; x < 64; ++x) {
        const std::uint8_t value = x < 32 ? 0 : 255;
        pixels.insert(pixels.end(), {value, value, value, 255});
    }
    auto& material = world.resource<Assets>().materials[shiny.index];
    material.base_color_texture.image =
        add(ImageData{.name = "halves", .width = 64, .height = 1, .pixels = pixels});
    material.specular = Vec3(0);
    MeshData mesh;
    mesh.positions = {{-1, -1, 0}, {3, -3, -2}, {-1, 1, 0}};
    mesh.normals.assign(3, {0, 0, 1});
    mesh.tangents.assign(3, {1, 0, 0, 1});
    mesh.uvs = {{0.01f, 0.5f}, {0.99f, 0.5f}, {0.01f, 0.5f}};
    mesh.indices = {0, 1, 2};
    for (const Vec3& p : mesh.positions) {
        grow(mesh.bounds, p);
    }
    show(mesh);
    eye = {0, 0, 1};
    directional_light({0, 0, 1});
    const auto first_lit = [&] {  // of the width, just above the lower edge
        const gpu::FloatImage image = drawn(ShadingRate::Vertex);
        int x = 0;
        while (x < kSide - 1 && image.at(x, kSide - 2, 0) < 0.1f) {
            ++x;
        }
        return static_cast<float>(x) / kSide;
    };
    CHECK(first_lit() == near(0.75).epsilon(0.04));
    rendering.screen_interpolation = true;
    CHECK(first_lit() == near(0.5).epsilon(0.04));
}

TEST_CASE_FIXTURE(
    Laboratory, "fake phong: a sphere map follows lights, the camera, materials and objects"
                    * technique("fakephong.envmap-bake")) {
    constexpr NamedRate kRate = {ShadingRate::Environment, "envmap"};
    show(make_ball(8));
    directional_light({0.2f, 0.4f, 1});
    point_light({0.6f, 1.5f, 3});
    CHECK(largest_distance(kRate) < kStep);
    SUBCASE("lights") {
        point_light({-1, -0.5f, 3});
    }
    SUBCASE("the camera") {
        eye = {-1.5f, 0.2f, 2.5f};
        laboratory.camera.eye = glm::dvec3(eye);
    }
    SUBCASE("materials") {
        auto& assets = world.resource<Assets>();
        assets.materials[shiny.index].shininess = 60;
        ++assets.material_version;
        laboratory.material.exponent = 60;
        laboratory.environment_exponent = 15;
    }
    SUBCASE("objects") {
        for (glm::dvec3& p : laboratory.mesh.positions) {
            p += glm::dvec3(0.4, 0, 0);
        }
        world.get<WorldTransform>(object).world = at({0.4f, 0, 0});
        world.get<PreviousWorldTransform>(object).world = at({0.4f, 0, 0});
    }
    CHECK(largest_distance(kRate) < kStep);
}

TEST_CASE_FIXTURE(
    Laboratory, "fake phong: on a fine ball a sphere map has Phong's own highlights"
                    * technique("fakephong.envmap-bake, fakephong.illum-phong")) {
    auto& material = world.resource<Assets>().materials[shiny.index];
    material.shading = ShadingModel::Phong;
    material.shininess = 8;
    show(make_ball(48));
    directional_light({0.2f, 0.4f, 1});
    CHECK(
        largest_difference(drawn(ShadingRate::Environment), drawn(ShadingRate::Pixel)) < 2 * kStep);
}

TEST_CASE_FIXTURE(
    Laboratory, "fake phong: cube, longitude and paraboloid maps hold every direction"
                    * technique("fakephong.envmap, fakephong.envmap-bake")) {
    auto& material = world.resource<Assets>().materials[shiny.index];
    material.shading = ShadingModel::Phong;
    material.shininess = 8;
    show(make_ball(48));
    const auto distance_with = [&](HighlightLayout layout) {
        rendering.highlight_layout = layout;
        return largest_difference(drawn(ShadingRate::Environment), drawn(ShadingRate::Pixel));
    };
    SUBCASE("from the front") {
        directional_light({0.2f, 0.4f, 1});
    }
    SUBCASE("from the side") {
        directional_light({-1, 0.1f, 0.2f});
    }
    SUBCASE("from below") {
        directional_light({0.3f, -0.6f, 1});
    }
    for (const HighlightLayout layout :
         {HighlightLayout::Longitude, HighlightLayout::Cube, HighlightLayout::Paraboloid}) {
        CAPTURE(static_cast<int>(layout));
        CHECK(distance_with(layout) < 2 * kStep);
    }
}

TEST_CASE_FIXTURE(
    Laboratory, "fake phong: near silhouettes a cube map has not the faults of a sphere map"
                    * technique("fakephong.envmap")) {
    auto& material = world.resource<Assets>().materials[shiny.index];
    material.shading = ShadingModel::Phong;
    material.shininess = 16;
    show(make_ball(10));
    directional_light({-1, 0.5f, -0.5f});
    const auto distance_with = [&](HighlightLayout layout) {
        rendering.highlight_layout = layout;
        return largest_difference(drawn(ShadingRate::Environment), drawn(ShadingRate::Pixel));
    };
    const float sphere = distance_with(HighlightLayout::Sphere);
    CHECK(sphere > 10 * kStep);
    CHECK(sphere > 1.5f * distance_with(HighlightLayout::Cube));
}

TEST_CASE_FIXTURE(
    Laboratory, "fake phong: at the centroid a Taylor series is exact for lights and eye far away"
                    * technique("fakephong.taylor")) {
    show(make_spread_triangle());
    directional_light({0.3f, 0.2f, 1});
    rendering.infinite_viewer = true;
    const RenderView centered = look({0, 0, 2}, {0, 0, 0}, 129, 129);
    const auto center_color = [&](ShadingRate rate) {
        rendering.shading = rate;
        world.insert_resource(rendering);
        return rgb_at(radiance(centered), 64, 64);
    };
    const Vec3 pixel = center_color(ShadingRate::Pixel);
    const Vec3 taylor = center_color(ShadingRate::Taylor);
    CHECK(glm::length(taylor - pixel) < 1e-3f);
    CHECK(glm::length(center_color(ShadingRate::Vertex) - pixel) > 0.02f);
}

TEST_CASE_FIXTURE(
    Laboratory, "fake phong: without its defects the hardware of 2002 draws the intended image"
                    * technique("fakephong.hw-blinn, fakephong.hw-quadratic")) {
    show(make_ball(5));
    world.get<WorldTransform>(object).world = affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(0.9f));
    world.get<PreviousWorldTransform>(object) = {world.get<WorldTransform>(object).world};
    directional_light({0.2f, 0.7f, 1});
    directional_light({-0.6f, 0.1f, 1});
    directional_light({0, 2, -0.4f});
    using Defect = bool HardwareDefects::*;
    const auto check = [&](ShadingRate hardware, ShadingRate meant, std::vector<Defect> defects) {
        rendering.hardware = {false, false, false, false, false, false};
        const gpu::FloatImage right = drawn(meant);
        CHECK(largest_difference(drawn(hardware), right) < 1e-5f);
        for (std::size_t i = 0; i < defects.size(); ++i) {
            CAPTURE(i);
            rendering.hardware.*defects[i] = true;
            CHECK(largest_difference(drawn(hardware), right) > kStep / 4);
            rendering.hardware.*defects[i] = false;
        }
    };
    check(
        ShadingRate::HwQuadratic, ShadingRate::Quadratic,
        {&HardwareDefects::first_light, &HardwareDefects::color_register,
         &HardwareDefects::midpoint_normals});
    rendering.blinn_axis = BlinnAxis::WorstCase;
    check(
        ShadingRate::HwBlinn, ShadingRate::BlinnMap,
        {&HardwareDefects::first_light, &HardwareDefects::axis_length, &HardwareDefects::world_up});
}

TEST_CASE_FIXTURE(
    Laboratory, "fake phong: only the hardware of 2002 lights normals that point away from H"
                    * technique("fakephong.hw-blinn")) {
    MeshData mesh = make_square();
    mesh.normals.assign(4, {-0.8f, 0, -0.6f});
    show(mesh);
    eye = {0, 0, 3};
    rendering.infinite_viewer = true;
    directional_light(glm::normalize(Vec3(0.436f, 0, -0.9f)));  // N.L is 0.19, N.H -0.91
    rendering.hardware = {false, false, false, false, false, false};
    const gpu::FloatImage right = drawn(ShadingRate::BlinnMap);
    CHECK(largest_difference(drawn(ShadingRate::HwBlinn), right) < 1e-5f);
    rendering.hardware.lit_backs = true;
    const Vec3 more = rgb_at(drawn(ShadingRate::HwBlinn), kSide / 2, kSide / 2)
                      - rgb_at(right, kSide / 2, kSide / 2);
    CHECK(std::abs(more.x - 0.4f * std::pow(0.914f, 20.0f)) < kStep);
}

TEST_CASE_FIXTURE(Laboratory, "fake phong: a double-sided surface is lit on its back") {
    auto& material = world.resource<Assets>().materials[shiny.index];
    material.double_sided = true;
    material.specular = Vec3(0);
    show(make_square());
    eye = {0.4f, 0.5f, -3};
    directional_light({0.2f, 0.4f, -1});
    const Vec3 pixel = rgb_at(drawn(ShadingRate::Pixel), kSide / 2, kSide / 2);
    CHECK(pixel.x > 0.3f);
    for (const NamedRate& named : kRates) {
        const Vec3 other = rgb_at(drawn(named.rate), kSide / 2, kSide / 2);
        CHECK_MESSAGE(glm::length(other - pixel) < kStep, std::string(named.method));
    }
}

TEST_CASE_FIXTURE(
    Laboratory, "fake phong: materials without Blinn's or Phong's model are lit per vertex") {
    auto& material = world.resource<Assets>().materials[shiny.index];
    material.shading = ShadingModel::Pbr;
    material.roughness = 0.3f;
    show(make_ball(5));
    directional_light({0.2f, 0.4f, 1});
    const gpu::FloatImage vertex = drawn(ShadingRate::Vertex);
    CHECK(largest_difference(drawn(ShadingRate::Quadratic), vertex) > 0.02f);
    for (const ShadingRate rate :
         {ShadingRate::Taylor, ShadingRate::BlinnMap, ShadingRate::QuadraticBlinn,
          ShadingRate::HwBlinn, ShadingRate::PhongMap, ShadingRate::Environment}) {
        CHECK(largest_difference(drawn(rate), vertex) < 1e-5f);
    }
}

TEST_CASE_FIXTURE(Laboratory, "fake phong: bad input leaves no NaN and no negative light") {
    MeshData mesh = make_square();
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 0}, {0, 0, 0}};
    mesh.normals = {{0, 0, 1}, {0, 0, -1}, {0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 0}};
    mesh.tangents.assign(6, {1, 0, 0, 1});
    mesh.uvs.assign(6, {0, 0});
    mesh.indices = {0, 1, 2, 0, 2, 3, 4, 5, 0, 4, 4, 4, 3, 4, 2};  // two have no area
    show(mesh);
    auto& assets = world.resource<Assets>();
    SUBCASE("lights in a vertex, in the eye and behind") {
        point_light({1, -1, 0});
        point_light(eye);
        point_light({0.2f, 0.1f, -1});
        directional_light({0, 0, -1});
    }
    SUBCASE("the eye in a vertex") {
        eye = {-1, 1, 0};
        point_light({0, 0, 1});
    }
    SUBCASE("exponent 0") {
        assets.materials[shiny.index].shininess = 0;
        point_light({0, 0, 1});
    }
    SUBCASE("exponent 10,000") {
        assets.materials[shiny.index].shininess = 10000;
        point_light({0, 0, 1});
    }
    SUBCASE("no light") {}
    for (const NamedRate& named : kRates) {
        CHECK_MESSAGE(is_all_finite(drawn(named.rate)), std::string(named.method));
    }
}

TEST_CASE_FIXTURE(
    Laboratory, "fake phong: no method leaves a hole or shows a surface just behind") {
    const MeshId ball = add(make_ball(16));
    const MeshId square = add(make_square());
    const MaterialId red = add(Material{
        .shading = ShadingModel::Unlit, .base_color = {0, 0, 0, 1}, .emission = {9, 0, 0}});
    for (int i = 0; i < 6; ++i) {
        const auto n = static_cast<float>(i);
        place(ball, shiny, at({0.7f * static_cast<float>(i % 3) - 0.7f, 0.3f * n - 0.6f, -2 - n}));
    }
    place(square, red, at({0, 0.3f, 0}));
    place(square, shiny, at({0, 0.3f, 3e-6f}));
    // Walls and a floor that extend beyond the edges of the image and behind the eye.
    for (const auto& [point, target] :
         {std::pair(Vec3(0, -0.7f, 0), Vec3(0.1f, -10, 0.2f)),
          std::pair(Vec3(-1.1f, 0, 0), Vec3(-10, 0.3f, 0.1f))}) {
        Affine pose = look_at(point, 2.0f * point - target);
        pose = pose * affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(40));
        place(square, shiny, pose);
    }
    directional_light({0.2f, 0.4f, 1});
    const RenderView view = look({0.37f, 0.51f, 2.9f}, {0.1f, -0.05f, 0}, 323, 201);
    const auto rendered = [&](ShadingRate rate) {
        world.insert_resource(Rendering{.shading = rate});
        return radiance(view);
    };
    const gpu::FloatImage pixel = rendered(ShadingRate::Pixel);
    for (const NamedRate& named : kRates) {
        const gpu::FloatImage image = rendered(named.rate);
        int holes = 0;
        int leaks = 0;
        for (int y = 1; y + 1 < view.height; ++y) {
            for (int x = 1; x + 1 < view.width; ++x) {
                holes += image.at(x, y, 3) == 0 && is_covered_around(pixel, x, y) ? 1 : 0;
                leaks += image.at(x, y, 0) > 5 ? 1 : 0;
            }
        }
        CHECK_MESSAGE(holes == 0, std::string(named.method));
        CHECK_MESSAGE(leaks == 0, std::string(named.method));
    }
}

TEST_CASE(
    "highlight layers: one per exponent, whatever the number of materials"
    * technique("fakephong.blinn-texture")) {
    const std::vector<Material> materials = {
        {.shading = ShadingModel::Blinn, .shininess = 80},
        {.shading = ShadingModel::Pbr, .shininess = 7},
        {.shading = ShadingModel::Phong, .shininess = 20},
        {.shading = ShadingModel::Blinn, .shininess = 5}};
    const HighlightLayers layers = layers_by_exponent(materials);
    CHECK(layers.exponents == std::vector<float>{1, 5, 80});
    CHECK(layers.of_record == std::vector<std::uint32_t>{0, 0, 2, 0, 2, 1});
}

TEST_CASE(
    "highlight layers: sphere maps have one per material, up to the limit"
    * technique("fakephong.blinn-texture")) {
    std::vector<Material> materials = {
        {.shading = ShadingModel::Blinn, .shininess = 80},
        {.shading = ShadingModel::Pbr, .shininess = 7},
        {.shading = ShadingModel::Phong, .shininess = 20}};
    const HighlightLayers layers = layers_by_material(materials);
    CHECK(layers.exponents == std::vector<float>{1, 80, 80});
    CHECK(layers.of_record == std::vector<std::uint32_t>{0, 0, 1, 0, 2});
    materials.resize(materials.size() + kMaxHighlightLayers, materials[0]);
    CHECK(layers_by_material(materials).exponents == std::vector<float>{1, 80});
}

TEST_CASE(
    "highlight layers: a thousand exponents share the available layers"
    * technique("fakephong.blinn-texture")) {
    std::vector<Material> materials;
    for (int i = 0; i < 1000; ++i) {
        materials.push_back(
            {.shading = ShadingModel::Blinn, .shininess = 1.5f + static_cast<float>(999 - i)});
    }
    const HighlightLayers layers = layers_by_exponent(materials);
    CHECK(layers.exponents.size() == kMaxHighlightLayers);
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const float given = layers.exponents.at(layers.of_record[i + 2]);
        CHECK(given >= materials[i].shininess);
        CHECK(given <= materials[i].shininess + 17);
    }
}

}  // namespace limn::test::fake_phong_test
