#include "bench/fakephong/blinn_illumination.h"
#include "bench/fakephong/lookup_texture.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>

namespace limn::fakephong::blinn_illumination_test {
namespace {

using test::near;

/// `h` as half vector of a directional light viewed from its own direction: L = V = H.
PhongScene scene_with_half_vector(const dvec3& h) {
    PhongScene scene = {.lights = {{.directional = true, .at = h}}};
    scene.camera = {.eye = 1e9 * glm::normalize(h), .target = dvec3(0), .up = {0, 1, 0}};
    scene.axis = BlinnAxis::WorldUp;
    return scene;
}

SurfacePoint at_origin(const dvec3& normal) {
    return {Vec3r(0, 0, 0), Vec3r(glm::normalize(normal))};
}

}  // namespace

TEST_CASE("fakephong: R mirrors L at N, and mirrored again is L" * technique("fakephong.vectors")) {
    const Vec3r n = {0, 0, 1};
    const Vec3r l = {0.6, 0, 0.8};
    const dvec3 r = plain(reflect(l, n));
    CHECK(glm::distance(r, dvec3(-0.6, 0, 0.8)) < 1e-15);
    CHECK(glm::distance(plain(reflect(Vec3r(r), n)), plain(l)) < 1e-15);
    const Vec3r v = {0, 0.8, 0.6};
    const Vec3r h = half_vector(l, v);
    CHECK(dot(h, l).value == near(dot(h, v).value).epsilon(1e-14));
    CHECK(glm::distance(plain(half_vector(l, l)), plain(l)) < 1e-15);
    CHECK(glm::distance(plain(reflect(l, h)), plain(v)) < 1e-15);  // N = H: R = V
}

TEST_CASE(
    "fakephong: illumination is linear in each light, and ks where N = H"
    * technique("fakephong.illum-blinn")) {
    PhongScene scene = {.lights = {{.at = {0.3, 0.2, 2}}, {.directional = true, .at = {1, 1, 1}}}};
    scene.channels = Channels::Full;
    const SurfacePoint point = at_origin({0.1, 0.2, 1});
    const Lit both = illuminate(scene, point);
    const Lit first = illuminate(scene, scene.lights[0], point);
    const Lit second = illuminate(scene, scene.lights[1], point);
    CHECK(
        both.tinted.x.value
        == near(scene.material.ambient + first.tinted.x.value + second.tinted.x.value));
    CHECK(both.highlight.x.value == near(first.highlight.x.value + second.highlight.x.value));

    PhongScene facing = scene_with_half_vector({0, 1, 1});
    facing.channels = Channels::Full;
    const Lit peak = illuminate(facing, at_origin({0, 1, 1}));
    CHECK(peak.highlight.x.value == near(facing.material.specular));
    CHECK(peak.tinted.x.value == near(facing.material.ambient + facing.material.diffuse));
}

TEST_CASE(
    "fakephong: no highlight without a half vector, at a light, at the eye or behind"
    * technique("fakephong.vectors")) {
    PhongScene scene = {.lights = {{.at = {0, 0, -5}}}};
    scene.camera.eye = {0, 0, 5};
    const SurfacePoint between = at_origin({0, 0, 1});  // L = -V
    CHECK(illuminate(scene, between).highlight.x.value == 0);
    const dvec2 rim = {
        blinn_coordinates(scene, scene.lights[0], between).x.value,
        blinn_coordinates(scene, scene.lights[0], between).y.value};
    CHECK(blinn_texture_value(32, rim.x, rim.y) == 0);

    scene.lights[0].at = {0, 0, 0};  // in the point
    const Lit lit = illuminate(scene, between);
    CHECK(std::isfinite(lit.highlight.x.value));
    scene.camera.eye = {0, 0, 0};
    CHECK(illuminate(scene, between).highlight.x.value == 0);
    const PhongScene behind = scene_with_half_vector({0, 0, 1});
    CHECK(illuminate(behind, at_origin({0, 0, -1})).highlight.x.value == 0);
}

TEST_CASE(
    "fakephong: the Blinn texture is the power of the projected normal"
    * technique("fakephong.blinn-texture")) {
    CHECK(blinn_texture_value(32, 0, 0) == 1);
    CHECK(blinn_texture_value(1, 0.6, 0) == near(0.8));
    CHECK(blinn_texture_value(32, 0, 0.6) == near(std::pow(0.8, 32)).epsilon(1e-12));
    CHECK(std::pow(0.8, 32) == near(7.9228e-4).epsilon(1e-4));
    CHECK(blinn_texture_value(0, 1, 0) == 0);  // at the rim, even of exponent 0
    CHECK(blinn_texture_value(0, 0.5, 0) == 1);
    CHECK(blinn_texture_value(10000, 0, 0) == 1);
    double last = 1;
    for (int i = 1; i <= 20; ++i) {
        const double value = blinn_texture_value(8, 0.05 * i * 0.8, 0.05 * i * 0.6);
        CHECK(value < last);
        last = value;
    }
}

TEST_CASE(
    "fakephong: at the rim and beyond, any texture is dark"
    * technique("fakephong.blinn-texture")) {
    const LookupTexture diffuse =
        bake_texture(256, [](double x, double y) { return dvec3(blinn_texture_value(1, x, y)); });
    CHECK(fetch(diffuse, {0, 0}).x.value == near(1).epsilon(1e-4));
    for (const double x : {-1.5, -1.0, 1.0, 1.5}) {
        CHECK(fetch(diffuse, {x, 0}).x.value == 0);
        CHECK(fetch(diffuse, {0, x}).x.value == 0);
    }
}

TEST_CASE(
    "fakephong: Blinn coordinates are those of the thesis and lie at sqrt(1 - (N.H)^2)"
    * technique("fakephong.blinn-map")) {
    const PhongScene front = scene_with_half_vector({0, 0, 1});
    const Vec2r at = blinn_coordinates(front, front.lights[0], at_origin({0.6, 0, 0.8}));
    CHECK(std::abs(at.x.value) < 1e-9);
    CHECK(at.y.value == near(-0.6));

    const PhongScene tilted = scene_with_half_vector({0, 1, 1});
    const SurfacePoint point = at_origin({0.3, 0.2, 1});
    const Vec2r general = blinn_coordinates(tilted, tilted.lights[0], point);
    CHECK(general.x.value == near(-0.532152).epsilon(1e-5));
    CHECK(general.y.value == near(-0.282216).epsilon(1e-5));
    const Vec2r same = blinn_coordinates(tilted, tilted.lights[0], at_origin({0, 1, 1}));
    CHECK(std::hypot(same.x.value, same.y.value) < 1e-7);

    // An axis turned about H turns (u, v).
    PhongScene turned = tilted;
    turned.axis = BlinnAxis::CameraUp;
    turned.camera.up = {1, 0.3, 0.2};
    const Vec2r other = blinn_coordinates(turned, turned.lights[0], point);
    CHECK(
        std::hypot(other.x.value, other.y.value)
        == near(std::hypot(general.x.value, general.y.value)).epsilon(1e-7));
    CHECK(std::abs(other.x.value - general.x.value) > 0.1);
}

TEST_CASE(
    "fakephong: the worst-case axis uses only one row of the texture"
    * technique("fakephong.blinn-axis")) {
    PhongScene scene = scene_with_half_vector({0.2, 1, 1});
    scene.axis = BlinnAxis::WorstCase;
    for (const dvec3& n : {dvec3(0.3, 0.2, 1), dvec3(-0.5, 0.4, 1), dvec3(0, 1, 0.1)}) {
        const Vec2r at = blinn_coordinates(scene, scene.lights[0], at_origin(n));
        CHECK(std::abs(at.y.value) < 1e-12);
        CHECK(at.x.value > 0);
    }
}

TEST_CASE(
    "fakephong: Blinn coordinates stay valid where the axis is parallel to H"
    * technique("fakephong.blinn-axis")) {
    const PhongScene scene = scene_with_half_vector({0, 1, 1e-13});
    PhongScene up = scene;
    up.camera.up = {0, 0, 1};
    const SurfacePoint point = at_origin({0.3, 1, 0.1});
    const Vec2r at = blinn_coordinates(up, up.lights[0], point);
    const double n_h = glm::normalize(dvec3(0.3, 1, 0.1)).y;
    CHECK(std::hypot(at.x.value, at.y.value) == near(std::sqrt(1 - n_h * n_h)).epsilon(1e-9));
}

TEST_CASE(
    "fakephong: normals behind the half vector map to the rim, where the printed program fails") {
    const PhongScene scene = scene_with_half_vector({0, 0, 1});
    const SurfacePoint behind = at_origin({0.1, 0, -1});
    const Vec2r ours = blinn_coordinates(scene, scene.lights[0], behind);
    CHECK(std::hypot(ours.x.value, ours.y.value) == near(1));
    const Vec2r printed = blinn_coordinates_as_printed(scene, scene.lights[0], behind);
    CHECK(blinn_texture_value(32, printed.x.value, printed.y.value) > 0.8);
}

TEST_CASE(
    "fakephong: appendix B shrinks the coordinates and brightens the vertex"
    * technique("fakephong.hw-blinn")) {
    const PhongScene scene = scene_with_half_vector({0, 1, 1});
    const SurfacePoint point = at_origin({0.3, 0.2, 1});
    const Vec2r at = blinn_coordinates_as_printed(scene, scene.lights[0], point);
    CHECK(at.x.value == near(-0.376288).epsilon(1e-5));
    CHECK(at.y.value == near(-0.199557).epsilon(1e-5));
    CHECK(blinn_texture_value(32, at.x.value, at.y.value) == near(0.0406).epsilon(2e-3));
    const Vec2r exact = blinn_coordinates(scene, scene.lights[0], point);
    CHECK(blinn_texture_value(32, exact.x.value, exact.y.value) == near(0.000738).epsilon(1e-3));
}

TEST_CASE(
    "fakephong: a Phong map holds N.L whatever the eye, and 0 behind"
    * technique("fakephong.phong-map")) {
    PhongScene scene = {.lights = {{.directional = true, .at = {0.3, 0.4, 1}}}};
    const SurfacePoint point = at_origin({0.2, -0.3, 1});
    const Vec2r at = phong_map_coordinates(scene, scene.lights[0], point);
    const double n_l =
        glm::dot(glm::normalize(dvec3(0.3, 0.4, 1)), glm::normalize(dvec3(0.2, -0.3, 1)));
    CHECK(blinn_texture_value(1, at.x.value, at.y.value) == near(n_l).epsilon(1e-9));
    scene.camera.eye = {3, 0, 4};
    const Vec2r moved = phong_map_coordinates(scene, scene.lights[0], point);
    CHECK(blinn_texture_value(1, moved.x.value, moved.y.value) == near(n_l).epsilon(1e-9));
    const Vec2r behind = phong_map_coordinates(scene, scene.lights[0], at_origin({0, 0, -1}));
    CHECK(blinn_texture_value(1, behind.x.value, behind.y.value) < 1e-6);
}

TEST_CASE(
    "fakephong: sphere map coordinates lie in the disc and are inverted by its directions"
    * technique("fakephong.envmap")) {
    PhongScene scene;
    scene.camera = {.eye = {0, 0, 1e9}, .target = dvec3(0)};
    // V = z: W = (0, 0, 1), (1, 0, 0) and (0, 0.6, 0.8) are mirrored at these normals.
    const auto at = [&](const dvec3& w) {
        return sphere_map_coordinates(scene, at_origin(glm::normalize(w) + dvec3(0, 0, 1)));
    };
    CHECK(std::abs(at({0, 0, 1}).x.value) < 1e-8);
    CHECK(0.5 + 0.5 * at({1, 0, 0}).x.value == near(0.853553).epsilon(1e-6));
    CHECK(0.5 + 0.5 * at({0, 0.6, 0.8}).y.value == near(0.658114).epsilon(1e-6));
    for (const dvec3& w : {dvec3(0.3, -0.5, 0.2), dvec3(-1, 0.2, -0.7), dvec3(0, 1, 0.01)}) {
        const Vec2r uv = at(w);
        CHECK(std::hypot(uv.x.value, uv.y.value) <= 1);
        const dvec3 back = sphere_map_direction(uv.x.value, uv.y.value);
        CHECK(glm::distance(back, glm::normalize(w)) < 1e-6);
    }
    const Vec2r singular = sphere_map_coordinates(scene, at_origin({1, 0, 0}));  // W = -z
    CHECK(std::isfinite(singular.x.value + singular.y.value));
}

TEST_CASE(
    "fakephong: an environment map of two lights is the sum of both maps"
    * technique("fakephong.envmap-bake")) {
    PhongScene scene = {
        .lights = {
            {.directional = true, .at = {0, 0, 1}, .color = {1, 0.5, 0}},
            {.directional = true, .at = {1, 1, 1}, .color = {0, 0.5, 1}}}};
    const auto both = highlight_environment(scene, dvec3(0));
    PhongScene one = scene;
    one.lights = {scene.lights[0]};
    PhongScene two = scene;
    two.lights = {scene.lights[1]};
    const auto first = highlight_environment(one, dvec3(0));
    const auto second = highlight_environment(two, dvec3(0));
    CHECK(glm::distance(first(0, 0), dvec3(1, 0.5, 0)) < 1e-12);
    for (const dvec2& p : {dvec2(0, 0), dvec2(0.3, 0.4), dvec2(-0.5, 0.2)}) {
        CHECK(glm::distance(both(p.x, p.y), first(p.x, p.y) + second(p.x, p.y)) < 1e-12);
    }
    CHECK(both(0.8, 0.8) == dvec3(0));  // outside the disc
}

TEST_CASE("fakephong: invalid scenes are rejected in one line") {
    const auto message = [](const PhongScene& scene) {
        const Status status = check_scene(scene);
        return status ? std::string() : status.error().message;
    };
    PhongScene scene = {.lights = {{}}};
    CHECK(message(scene).empty());
    scene.material.exponent = 10001;
    CHECK(message(scene) == "scene: found exponent 10001, expected 0 to 10000");
    scene.material.exponent = std::nan("");
    CHECK_FALSE(message(scene).empty());
    scene.material.exponent = 0;
    CHECK(message(scene).empty());
    scene.mesh = {.positions = {dvec3(0)}, .normals = {dvec3(0)}, .triangles = {{0, 0, 1}}};
    CHECK(message(scene) == "scene: found vertex 1 in triangle 0, expected less than 1");
    scene.mesh = {};
    scene.lights.clear();
    CHECK(message(scene) == "scene: found lights 0, expected 1 to 8");
    scene.lights = {{}};
    scene.camera.up = scene.camera.eye;
    CHECK(message(scene).find("along its up vector") != std::string::npos);
}

}  // namespace limn::fakephong::blinn_illumination_test
