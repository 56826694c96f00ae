#include "bench/fakephong/phong_models.h"
#include "bench/fakephong/phong_raster.h"
#include "bench/fakephong/shading_method.h"
#include "bench/fakephong/taylor_series.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace limn::fakephong::shading_method_test {
namespace {

using test::near;

Facet facet_of(const PhongScene& scene, std::size_t index = 0) {
    Facet facet;
    REQUIRE(make_facet(scene.mesh, index, facet));
    return facet;
}

/// The canonical triangle with three different normals, and textures evaluated exactly.
PhongScene bent_triangle() {
    PhongScene scene = triangle_scene();
    scene.texture_size = 0;
    scene.mesh.normals = {
        glm::normalize(dvec3(0, 0.4, 1)), glm::normalize(dvec3(-0.3, -0.1, 1)),
        glm::normalize(dvec3(0.2, -0.3, 1))};
    return scene;
}

double highlight(
    const ShadingContext& context, const ShadingMethod& method, const FacetSetup& setup, double s,
    double t) {
    return method.shade(context, setup, s, t).highlight.x.value;
}

/// Fraction of the triangle brighter than one half, and its brightest value.
struct Spot {
    double fraction = 0, peak = 0, y = 0;
};
Spot spot_of(const PhongScene& scene, const char* id) {
    const ShadingContext context = make_shading_context(scene);
    const ShadingMethod& method = *find_method(id);
    const Facet facet = facet_of(scene);
    FacetSetup setup;
    method.prepare(context, facet, setup);
    Spot spot;
    int count = 0;
    constexpr int kSteps = 200;
    for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; i + j < kSteps; ++j) {
            const double s = (i + 0.25) / kSteps;
            const double t = (j + 0.25) / kSteps;
            const double value = highlight(context, method, setup, s, t);
            ++count;
            spot.fraction += value > 0.5 ? 1 : 0;
            if (value > spot.peak) {
                spot.peak = value;
                spot.y = point_at(facet, s, t).position.y.value;
            }
        }
    }
    spot.fraction /= count;
    return spot;
}

}  // namespace

TEST_CASE(
    "fakephong: each method is exact at the sample points that it claims, and only there"
    * technique("fakephong.metric-analytic")) {
    const PhongScene scene = bent_triangle();
    const ShadingContext context = make_shading_context(scene);
    const Facet facet = facet_of(scene);
    const auto points = six_points(facet);
    for (const ShadingMethod& method : shading_methods()) {
        if (method.id == "phong-map") {
            continue;  // has no highlights
        }
        CAPTURE(std::string(method.id));
        FacetSetup setup;
        method.prepare(context, facet, setup);
        int exact = 0;
        for (std::size_t i = 0; i < 6; ++i) {
            const double wanted = illuminate(scene, points[i]).highlight.x.value;
            const auto& [s, t] = kSixPoints[i];
            exact += std::abs(highlight(context, method, setup, s, t) - wanted) < 1e-5 ? 1 : 0;
        }
        if (method.id == "hw-quadratic") {
            CHECK(exact >= 3);  // one half is no value of an 8-bit register
        } else if (method.id == "hw-blinn") {
            CHECK(exact < 3);  // where the axis happens to be orthogonal to H, or all is dark
        } else {
            CHECK(exact == method.exact_points);
        }
    }
}

TEST_CASE(
    "fakephong: lightings per triangle are 3, 6, 6, 3, 3, 6"
    * technique("fakephong.metric-efficiency")) {
    const PhongScene scene = bent_triangle();
    const ShadingContext context = make_shading_context(scene);
    const Facet facet = facet_of(scene);
    constexpr int kThesis[kTableColumns] = {3, 6, 6, 3, 3, 6};
    for (std::size_t i = 0; i < shading_methods().size(); ++i) {
        const ShadingMethod& method = shading_methods()[i];
        CAPTURE(std::string(method.id));
        FacetSetup setup;
        const Work before = counted_work;
        method.prepare(context, facet, setup);
        CHECK((counted_work - before).lightings == method.lightings);
        if (i >= 1 && i <= kTableColumns) {
            CHECK(method.lightings == kThesis[i - 1]);
        }
    }
}

TEST_CASE(
    "fakephong: colors along a shared edge depend only on that edge"
    * technique("fakephong.quadratic")) {
    // Two triangles on one edge, the far corners and their normals different.
    PhongScene scene = bent_triangle();
    scene.mesh.positions.push_back({0, -2, 0.7});
    scene.mesh.normals.push_back(glm::normalize(dvec3(0.5, -1, 0.6)));
    scene.mesh.triangles.push_back({2, 1, 3});
    scene.channels = Channels::Full;
    const ShadingContext context = make_shading_context(scene);
    for (const char* id :
         {"phong", "gouraud", "gouraud-subdivided", "quadratic", "cubic", "envmap", "blinn-map",
          "quadratic-blinn", "hw-blinn", "normals-quadratic", "normals-spherical", "taylor"}) {
        const ShadingMethod& method = *find_method(id);
        CAPTURE(std::string(method.id));
        FacetSetup upper;
        FacetSetup lower;
        method.prepare(context, facet_of(scene, 0), upper);
        method.prepare(context, facet_of(scene, 1), lower);
        double largest = 0;
        for (int i = 0; i <= 20; ++i) {
            const double k = i / 20.0;  // corner 1 to corner 2 above; corner 1 to corner 0 below
            const Lit a = method.shade(context, upper, 1 - k, k);
            const Lit b = method.shade(context, lower, 1 - k, 0);
            largest = std::max(
                {largest, std::abs(a.highlight.x.value - b.highlight.x.value),
                 std::abs(a.tinted.x.value - b.tinted.x.value)});
        }
        if (method.id == "taylor") {
            CHECK(largest > 0.01);  // the thesis: not continuous
        } else {
            CHECK(largest < 1e-9);
        }
    }
}

TEST_CASE(
    "fakephong: linear colors have no maximum inside a triangle" * technique("fakephong.gouraud")) {
    const Spot spot = spot_of(triangle_scene(), "gouraud");
    CHECK(spot.peak == near(0.0107).epsilon(0.01));
    CHECK(spot.fraction == 0);
}

TEST_CASE("fakephong: highlights on the triangle have the derived peaks and sizes") {
    PhongScene scene = triangle_scene();
    scene.texture_size = 0;
    scene.material.exponent = 32;
    scene.environment_exponent = 8;
    scene.lights = {{.at = {0, -0.2, 0.6}}};
    scene.camera.eye = {0, 0, 20};
    const Spot phong = spot_of(scene, "phong");
    CHECK(phong.peak == near(1).epsilon(1e-3));
    CHECK(phong.y == near(-0.2 * 20 / 20.6).epsilon(0.05));
    CHECK(phong.fraction == near(0.157).epsilon(0.01));
    CHECK(spot_of(scene, "gouraud-subdivided").peak == near(0.381).epsilon(0.02));
    CHECK(spot_of(scene, "quadratic").fraction == 0);
    CHECK(spot_of(scene, "envmap").fraction == 1);
    CHECK(spot_of(scene, "envmap").peak == near(0.699).epsilon(0.01));
    const Spot blinn = spot_of(scene, "blinn-map");
    CHECK(blinn.fraction == near(0.369).epsilon(0.01));
    CHECK(blinn.y == near(-0.181).epsilon(0.05));
    const Spot smooth = spot_of(scene, "quadratic-blinn");
    CHECK(smooth.fraction == near(0.253).epsilon(0.01));
    CHECK(smooth.y == near(-0.170).epsilon(0.05));
}

TEST_CASE("fakephong: a Phong map has the diffuse light of the corners") {
    PhongScene scene = bent_triangle();
    scene.channels = Channels::Diffuse;
    const ShadingContext context = make_shading_context(scene);
    const ShadingMethod& method = *find_method("phong-map");
    const Facet facet = facet_of(scene);
    FacetSetup setup;
    method.prepare(context, facet, setup);
    for (std::size_t i = 0; i < 3; ++i) {
        const double s = i == 1 ? 1 : 0;
        const double t = i == 2 ? 1 : 0;
        const double wanted = illuminate(scene, facet.corners[i]).tinted.x.value;
        CHECK(method.shade(context, setup, s, t).tinted.x.value == near(wanted).epsilon(1e-9));
    }
}

TEST_CASE(
    "fakephong: diffuse light from a Blinn texture is exact at the samples, by either map"
    * technique("fakephong.blinn-map")) {
    PhongScene scene = bent_triangle();
    scene.channels = Channels::Full;
    scene.diffuse_texture = true;
    scene.lights.push_back({.directional = true, .at = {0.5, 1, 0.3}});
    const ShadingContext context = make_shading_context(scene);
    const Facet facet = facet_of(scene);
    const auto points = six_points(facet);
    for (const char* id : {"blinn-map", "quadratic-blinn"}) {
        const ShadingMethod& method = *find_method(id);
        FacetSetup setup;
        const Work before = counted_work;
        method.prepare(context, facet, setup);
        CHECK((counted_work - before).lightings == 2 * 2 * method.lightings);
        for (std::size_t i = 0; i < 6; i += method.lightings == 3 ? 2 : 1) {
            const Lit wanted = illuminate(scene, points[i]);
            const Lit found = method.shade(context, setup, kSixPoints[i][0], kSixPoints[i][1]);
            CHECK(found.tinted.x.value == near(wanted.tinted.x.value).epsilon(1e-9));
            CHECK(found.highlight.x.value == near(wanted.highlight.x.value).epsilon(1e-9));
        }
    }
}

TEST_CASE(
    "fakephong: a quadratic goes through its samples and reproduces quadratic fields"
    * technique("fakephong.quadratic")) {
    const auto field = [](double s, double t) {
        return 1 + 2 * s - 3 * t + 4 * s * s - s * t + t * t;
    };
    std::array<Real, 6> samples;
    for (std::size_t i = 0; i < 6; ++i) {
        samples[i] = field(kSixPoints[i][0], kSixPoints[i][1]);
    }
    const auto c = quadratic_through(samples);
    for (const dvec2& p : {dvec2(0.2, 0.3), dvec2(0.5, 0.5), dvec2(0.1, 0.8), dvec2(1, 0)}) {
        CHECK(evaluate_quadratic(c, p.x, p.y).value == near(field(p.x, p.y)));
    }
    const auto flat = quadratic_through(std::array<Real, 6>{0.3, 0.3, 0.3, 0.3, 0.3, 0.3});
    for (std::size_t i = 1; i < 6; ++i) {
        CHECK(std::abs(flat[i].value) < 1e-15);
    }
    const auto printed = quadratic_through(
        std::array<Real, 6>{0.00340, 0.05873, 0.01068, 0.38108, 0.01068, 0.05873});
    CHECK(printed[1].value == near(0.21406).epsilon(1e-3));
    CHECK(printed[3].value == near(-0.20678).epsilon(1e-3));
    CHECK(printed[4].value == near(1.06805).epsilon(1e-3));
}

TEST_CASE("fakephong: a cubic is exact at its ten nodes" * technique("fakephong.cubic")) {
    const PhongScene scene = bent_triangle();
    const ShadingContext context = make_shading_context(scene);
    const Facet facet = facet_of(scene);
    FacetSetup setup;
    prepare_cubic(context, facet, setup);
    for (int i = 0; i <= 3; ++i) {
        for (int j = 0; i + j <= 3; ++j) {
            const Lit wanted = illuminate(scene, point_at(facet, i / 3.0, j / 3.0));
            CHECK(
                shade_cubic(context, setup, i / 3.0, j / 3.0).highlight.x.value
                == near(wanted.highlight.x.value).epsilon(1e-9));
        }
    }
    setup.lit.fill({{}, {1, 1, 1}});  // the basis sums to 1
    CHECK(shade_cubic(context, setup, 0.37, 0.21).highlight.x.value == near(1));
}

TEST_CASE(
    "fakephong: the Taylor series has the derivatives of N.L of a unit N"
    * technique("fakephong.taylor")) {
    const dvec3 l = glm::normalize(dvec3(0.3, 0.2, 1));
    const dvec3 a = {0.2, 0.1, -0.05};
    const dvec3 b = {-0.1, 0.3, 0.02};
    const dvec3 c = {0.1, 0.05, 1};
    const auto f = taylor_series(Vec3r(l), Vec3r(a), Vec3r(b), Vec3r(c));
    CHECK(f[1].value == near(0.052054).epsilon(1e-4));
    CHECK(f[3].value == near(-0.047252).epsilon(1e-4));
    CHECK(f[4].value == near(-0.009959).epsilon(1e-4));
    const auto exact = [&](double x, double y) {
        const dvec3 n = x * a + y * b + c;
        return glm::dot(l, n) / glm::length(n);
    };
    constexpr double kStep = 1e-4;
    CHECK(f[0].value == near(exact(0, 0)));
    CHECK(f[2].value == near((exact(0, kStep) - exact(0, -kStep)) / (2 * kStep)).epsilon(1e-6));
    CHECK(
        f[5].value
        == near((exact(0, kStep) - 2 * exact(0, 0) + exact(0, -kStep)) / (kStep * kStep))
               .epsilon(1e-5));
    const auto constant = taylor_series(Vec3r(l), {}, {}, Vec3r(c));
    CHECK(constant[0].value == near(exact(0, 0)));
    CHECK(constant[1].value == 0);
}

TEST_CASE(
    "fakephong: spherical normals meet the normalized sum halfway, quadratic ones overshoot 1"
    * technique("fakephong.normal-interp-variants")) {
    PhongScene scene = bent_triangle();
    const Facet facet = facet_of(scene);
    const ShadingContext context = make_shading_context(scene);
    const auto points = six_points(facet);
    FacetSetup setup;
    prepare_quadratic_normals(context, facet, setup);
    for (std::size_t i = 0; i < 6; ++i) {
        const dvec3 n = plain(evaluate_quadratic(setup.normal, kSixPoints[i][0], kSixPoints[i][1]));
        CHECK(glm::distance(n, plain(points[i].normal)) < 1e-12);
    }
    prepare_spherical_normals(context, facet, setup);
    for (std::size_t i = 0; i < 6; ++i) {
        const double wanted = illuminate(scene, points[i]).highlight.x.value;
        CHECK(
            shade_spherical_normals(context, setup, kSixPoints[i][0], kSixPoints[i][1])
                .highlight.x.value
            == near(wanted).epsilon(1e-9));
    }
}

TEST_CASE("fakephong: normals that cancel or are zero become the face normal") {
    PhongScene scene = bent_triangle();
    scene.channels = Channels::Full;
    scene.mesh.normals = {dvec3(1, 0, 0), dvec3(-1, 0, 0), dvec3(0, 0, 0)};
    const Facet facet = facet_of(scene);
    CHECK(glm::distance(plain(facet.corners[2].normal), dvec3(0, 0, 1)) < 1e-12);
    CHECK(glm::distance(plain(six_points(facet)[1].normal), dvec3(0, 0, 1)) < 1e-12);
    const ShadingContext context = make_shading_context(scene);
    for (const ShadingMethod& method : shading_methods()) {
        CAPTURE(std::string(method.id));
        FacetSetup setup;
        method.prepare(context, facet, setup);
        for (const auto& [s, t] : kSixPoints) {
            const Lit lit = method.shade(context, setup, s, t);
            CHECK(std::isfinite(lit.highlight.x.value));
            CHECK(std::isfinite(lit.tinted.x.value));
        }
    }
}

TEST_CASE(
    "fakephong: appendix A equals quadratic shading except for its 8-bit coordinates and its gate"
    * technique("fakephong.hw-quadratic")) {
    const PhongScene scene = bent_triangle();
    const ShadingContext context = make_shading_context(scene);
    const Facet facet = facet_of(scene);
    FacetSetup printed;
    FacetSetup exact;
    prepare_hardware_quadratic(context, facet, printed);
    prepare_quadratic(context, facet, exact);
    for (std::size_t i = 0; i < 6; ++i) {
        CHECK(printed.lit[i].highlight.x.value == near(exact.lit[i].highlight.x.value));
        CHECK(std::abs(printed.lit[i].highlight.x.value) <= 8);
    }
    const double in_register =
        shade_hardware_quadratic(context, printed, 0.3, 0.3).highlight.x.value;
    const double smooth = shade_quadratic(context, exact, 0.3, 0.3).highlight.x.value;
    CHECK(in_register != smooth);
    CHECK(in_register == near(smooth).epsilon(0.05));

    PhongScene behind = scene;
    behind.lights = {{.directional = true, .at = {1, 0, -0.2}}};
    prepare_hardware_quadratic(make_shading_context(behind), facet_of(behind), printed);
    CHECK(printed.lit[0].highlight.x.value == 0);
    CHECK(illuminate(behind, facet.corners[0]).highlight.x.value > 0);
}

}  // namespace limn::fakephong::shading_method_test
