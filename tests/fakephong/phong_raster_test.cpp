#include "bench/fakephong/phong_models.h"
#include "bench/fakephong/phong_raster.h"
#include "content/make/models/shapes.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace limn::fakephong::phong_raster_test {
namespace {

using test::near;

std::vector<PhongScene> all_scenes() {
    return {
        triangle_scene(), teapot_scene(), dodecahedron_scene(), sphere_scene(),
        fine_sphere_scene()};
}

double correctness(const PhongScene& scene, const char* id) {
    const PhongImage phong = draw(scene, *find_method("phong"));
    return color_correctness(phong.color, draw(scene, *find_method(id)).color, phong.mask);
}

bool all_finite(const PhongImage& image) {
    return std::all_of(image.color.pixels.begin(), image.color.pixels.end(), [](const Vec3& p) {
        return std::isfinite(p.x + p.y + p.z);
    });
}

}  // namespace

TEST_CASE("fakephong: the models have the facets of the thesis" * technique("fakephong.scenes")) {
    CHECK(sphere_scene().mesh.triangles.size() == 40);
    CHECK(dodecahedron_scene().mesh.triangles.size() == 30);
    CHECK(fine_sphere_scene().mesh.triangles.size() == 3750);
    CHECK(make_dodecahedron({}).indices.size() == 3 * 36);
    CHECK(teapot_scene().mesh.triangles.size() == 3750);
    for (const PhongScene& scene : all_scenes()) {
        CHECK(check_scene(scene));
    }
}

TEST_CASE("fakephong: a coarse sphere has no holes, and its rim no gaps between facets") {
    const PhongImage image = draw(sphere_scene(), *find_method("phong"));
    const int size = image.color.width;
    for (int y = 0; y < size; ++y) {  // a convex shape: one run of pixels in each row
        int runs = 0;
        for (int x = 0; x < size; ++x) {
            const bool on = image.mask[static_cast<std::size_t>(y * size + x)] != 0;
            const bool before =
                x > 0 && image.mask[static_cast<std::size_t>(y * size + x - 1)] != 0;
            runs += on && !before ? 1 : 0;
        }
        CHECK(runs <= 1);
    }
    const auto covered = std::count(image.mask.begin(), image.mask.end(), 1);
    CHECK(image.pixels == covered);  // no pixel on a shared edge is drawn twice
}

TEST_CASE("fakephong: the image of the triangle is its own mirror image, by every method") {
    for (const ShadingMethod& method : shading_methods()) {
        if (method.id == "hw-quadratic" || method.id == "normals-spherical") {
            continue;  // s and t are rounded; two great circles in an order
        }
        CAPTURE(std::string(method.id));
        const PhongImage image = draw(triangle_scene(), method);
        const int size = image.color.width;
        float largest = 0;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size / 2; ++x) {
                const Vec3 d =
                    image.color.pixels[static_cast<std::size_t>(y * size + x)]
                    - image.color.pixels[static_cast<std::size_t>(y * size + size - 1 - x)];
                largest = std::max(largest, std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
            }
        }
        CHECK(largest < 1e-4f);
    }
}

TEST_CASE(
    "fakephong: on coarse spheres the quadratic Blinn map is best and the Blinn map next"
    * technique("fakephong.quadratic-blinn, fakephong.scenes")) {
    PhongScene fans = sphere_scene();
    fans.mesh = phong_mesh(make_dodecahedron({.radius = 1}));
    PhongScene flat = sphere_scene();
    flat.mesh = make_coarse_sphere(10, 3);
    for (const PhongScene& scene : {dodecahedron_scene(), sphere_scene(), fans, flat}) {
        const double blinn = correctness(scene, "blinn-map");
        CHECK(correctness(scene, "quadratic-blinn") > blinn);
        for (const char* other : {"gouraud", "gouraud-subdivided", "quadratic", "envmap"}) {
            CHECK(blinn > correctness(scene, other));
        }
    }
}

TEST_CASE("fakephong: on 3,750 facets every method exceeds 0.98" * technique("fakephong.scenes")) {
    for (std::size_t i = 1; i <= kTableColumns; ++i) {
        const std::string id(shading_methods()[i].id);
        CHECK(correctness(fine_sphere_scene(), id.c_str()) > 0.98);
    }
}

TEST_CASE(
    "fakephong: perspective divides s, t and texture coordinates"
    * technique("fakephong.barycentric, fakephong.texmap")) {
    // A square in two triangles that leans away: the far half is less than half of its image.
    PhongScene scene = triangle_scene();
    scene.channels = Channels::Full;
    scene.material = {.ambient = 1, .diffuse = 0, .specular = 0, .checks = 2};
    scene.mesh = {
        .positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, -4}, {-1, 1, -4}},
        .normals = std::vector<dvec3>(4, dvec3(0, 0, 1)),
        .uvs = {{0.25, 0}, {0.25, 0}, {0.25, 1}, {0.25, 1}},
        .triangles = {{0, 1, 2}, {0, 2, 3}}};
    scene.camera = {.eye = {0, 0, 2}, .half_size = 0.6, .size = 128};
    const PhongImage image = draw(scene, *find_method("gouraud"));
    // v = 1/2 is the point (0, 0, -2), at the center of the image; v at the center of the screen's
    // span, from y = -1/2 to 1/6, would be at -1/6.
    const auto at = [&](int y) {
        return image.color.pixels[static_cast<std::size_t>(y * 128 + 64)].x;
    };
    CHECK(at(66) == near(1));
    CHECK(at(61) == near(0.5));
}

TEST_CASE("fakephong: many lights add up, and each counts its lightings") {
    PhongScene scene = sphere_scene();
    scene.lights.push_back({.directional = true, .at = {1, -1, 2}, .color = {0.5, 0, 0}});
    const PhongImage one = draw(sphere_scene(), *find_method("blinn-map"));
    const PhongImage two = draw(scene, *find_method("blinn-map"));
    CHECK(two.setup.lightings == 2 * one.setup.lightings);
    CHECK(two.shading.fetches == 2 * one.shading.fetches);
    const PhongImage map = draw(scene, *find_method("envmap"));
    CHECK(map.shading.fetches == map.pixels);  // all lights in one fetch
    CHECK(correctness(scene, "quadratic-blinn") > 0.99);
}

TEST_CASE("fakephong: facets without area, behind the eye, facing away or with NaN are skipped") {
    PhongScene scene = triangle_scene();
    scene.channels = Channels::Full;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    scene.mesh.positions.insert(
        scene.mesh.positions.end(), {{0, 0, 30}, {1, 0, 30}, {0, 1, 30}, {nan, 0, 0}});
    scene.mesh.normals.insert(scene.mesh.normals.end(), 4, dvec3(0, 0, 1));
    scene.mesh.uvs.clear();
    scene.mesh.triangles = {{0, 0, 1}, {0, 2, 1}, {3, 4, 5}, {0, 1, 6}};
    for (const ShadingMethod& method : shading_methods()) {
        const PhongImage image = draw(scene, method);
        CHECK(image.triangles == 0);
        CHECK(image.pixels == 0);
    }
    scene.mesh.triangles = {};
    CHECK(correctness(scene, "gouraud") == 1);  // no pixel counts
}

TEST_CASE("fakephong: a facet needs an area, however small, and finite corners") {
    PhongMesh mesh;
    mesh.positions = {
        {0, 0, 0},
        {1, 0, 0},
        {3, 0, 0},
        {0, 1e-12, 0},
        {std::numeric_limits<double>::infinity(), 0, 0}};
    mesh.normals.assign(5, dvec3(0, 0, 1));
    mesh.triangles = {{0, 1, 1}, {0, 1, 2}, {0, 1, 4}, {0, 1, 3}};
    Facet facet;
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK_FALSE(make_facet(mesh, i, facet));
    }
    CHECK(make_facet(mesh, 3, facet));
    CHECK(plain(facet.face_normal) == dvec3(0, 0, 1));
}

TEST_CASE("fakephong: an edge through pixel centers belongs to one side") {
    PhongScene scene = triangle_scene();
    scene.camera = {.eye = {0, 0, 1}, .half_size = 1, .size = 34};
    PhongMesh& mesh = scene.mesh;
    mesh.positions.clear();
    mesh.uvs.clear();
    for (int y = -1; y <= 1; ++y) {  // four squares, of two triangles each, seen over 8.5 .. 25.5
        for (int x = -1; x <= 1; ++x) {
            mesh.positions.emplace_back(0.5 * x, 0.5 * y, 0);
        }
    }
    mesh.normals.assign(9, dvec3(0, 0, 1));
    const auto covered = [&](std::vector<std::array<std::uint32_t, 3>> triangles) {
        mesh.triangles = std::move(triangles);
        const PhongImage image = draw(scene, *find_method("phong"));
        return std::count(image.mask.begin(), image.mask.end(), 1);
    };
    std::int64_t parts = 0;
    std::vector<std::array<std::uint32_t, 3>> all;
    for (const std::uint32_t a : {0u, 1u, 3u, 4u}) {
        for (const std::array<std::uint32_t, 3>& t :
             {std::array{a, a + 1, a + 4}, std::array{a, a + 4, a + 3}}) {
            parts += covered({t});
            all.push_back(t);
        }
    }
    CHECK(covered(all) == 17 * 17);
    CHECK(parts == 17 * 17);
}

TEST_CASE(
    "fakephong: a triangle through the eye is cut at the near plane"
    * technique("fakephong.pipeline")) {
    PhongScene scene = triangle_scene();
    scene.mesh.positions = {{0, 0.02, 0}, {-50, -0.5, 60}, {50, -0.5, 60}};
    scene.mesh.normals = std::vector<dvec3>(3, dvec3(0, 1, 0));
    scene.camera.eye = {0, 1, 20};
    scene.camera.target = {0, 0, 0};
    const PhongImage image = draw(scene, *find_method("quadratic-blinn"));
    CHECK(image.pixels > 100);
    CHECK(all_finite(image));
}

TEST_CASE(
    "fakephong: light on the surface, at the eye, exponents 0 and 10,000 give finite images") {
    for (const double exponent : {0.0, 10000.0}) {
        for (const dvec3& light :
             {dvec3(0, 0, 0), dvec3(0, 0, 20), dvec3(0, 1, 0), dvec3(0, 0, -1)}) {
            PhongScene scene = triangle_scene();
            scene.camera.size = 32;
            scene.channels = Channels::Full;
            scene.material.exponent = exponent;
            scene.environment_exponent = exponent / 4;
            scene.lights[0].at = light;
            REQUIRE(check_scene(scene));
            for (const ShadingMethod& method : shading_methods()) {
                CAPTURE(std::string(method.id));
                CHECK(all_finite(draw(scene, method)));
            }
        }
    }
}

TEST_CASE("fakephong: a million triangles are drawn") {
    PhongScene scene = sphere_scene();
    scene.mesh = make_coarse_sphere(1000, 501);
    scene.camera.size = 64;
    scene.texture_size = 64;
    REQUIRE(scene.mesh.triangles.size() == 1'000'000);
    const PhongImage image = draw(scene, *find_method("gouraud"));
    const PhongImage phong = draw(scene, *find_method("phong"));
    CHECK(image.triangles > 300'000);
    CHECK(color_correctness(phong.color, image.color, phong.mask) > 0.999);
}

}  // namespace limn::fakephong::phong_raster_test
