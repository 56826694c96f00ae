#include "content/bake/photometric_normals.h"
#include "ecs/base/rng.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <vector>

namespace limn::photometric_normals_test {
namespace {

using test::near;

const std::vector<Vec3>& three_lights() {
    static const std::vector<Vec3> lights = {
        glm::normalize(Vec3(1, 0, 1)), glm::normalize(Vec3(-1, 0, 1)),
        glm::normalize(Vec3(0, 1, 1))};
    return lights;
}

std::vector<float> shot(const std::vector<Vec3>& lights, const Vec3& normal, float reflectance) {
    std::vector<float> radiance;
    for (const Vec3& light : lights) {
        radiance.push_back(reflectance * std::max(glm::dot(normal, light), 0.0f));
    }
    return radiance;
}

TEST_CASE(
    "photometric normals: the published measurements give their normal and reflectance"
    * technique("face.photometric-normals")) {
    const Vec3 normal = {0.2f, 0.3f, 0.932738f};
    const std::vector<float> measured = shot(three_lights(), normal, 0.7f);
    CHECK(measured[0] == near(0.560677).epsilon(1e-5));
    CHECK(measured[1] == near(0.362687).epsilon(1e-5));
    CHECK(measured[2] == near(0.610174).epsilon(1e-5));
    const PhotometricPixel found =
        solve_photometric(three_lights(), std::vector<float>{0.560677f, 0.362687f, 0.610174f}, 0);
    CHECK(glm::distance(found.normal, normal) < 2e-6f);
    CHECK(found.reflectance == near(0.7).epsilon(2e-6));
}

TEST_CASE(
    "photometric normals: brighter lights change the reflectance, never the normal"
    * technique("face.photometric-normals")) {
    const std::vector<float> once = {0.3f, 0.2f, 0.4f};
    std::vector<float> tenfold = once;
    for (float& radiance : tenfold) {
        radiance *= 10;
    }
    const PhotometricPixel a = solve_photometric(three_lights(), once, 0);
    const PhotometricPixel b = solve_photometric(three_lights(), tenfold, 0);
    CHECK(glm::distance(a.normal, b.normal) < 1e-6f);
    CHECK(b.reflectance == near(10 * a.reflectance));
}

TEST_CASE(
    "photometric normals: any normal that three of five lights reach is found"
    * technique("face.photometric-normals")) {
    std::vector<Vec3> lights = three_lights();
    lights.push_back(glm::normalize(Vec3(0, -1, 1)));
    lights.push_back(Vec3(0, 0, 1));
    Random random(7, 0, 0, 0);
    int shadowed = 0;
    for (int i = 0; i < 200; ++i) {
        const Vec3 normal = glm::normalize(
            Vec3(2 * random.uniform() - 1, 2 * random.uniform() - 1, 0.6f + random.uniform()));
        const std::vector<float> radiance = shot(lights, normal, 0.5f);
        int lit = 0;
        for (const float value : radiance) {
            lit += value > 1e-4f ? 1 : 0;
        }
        if (lit < 3) {
            continue;
        }
        shadowed += lit < 5 ? 1 : 0;
        const PhotometricPixel found = solve_photometric(lights, radiance, 1e-4f);
        if (found.reflectance > 0) {  // the lights that are left may lie in one plane
            CHECK(glm::distance(found.normal, normal) < 1e-4f);
            CHECK(found.reflectance == near(0.5).epsilon(1e-4));
        } else {
            CHECK(lit == 3);
        }
    }
    CHECK(shadowed > 10);
}

TEST_CASE(
    "photometric normals: too few, coplanar or empty lights are rejected with their number"
    * technique("face.photometric-normals")) {
    const auto refusal = [](const std::vector<Vec3>& lights) {
        const Status status = check_photometric_lights(lights);
        return status ? "they are taken" : status.error().message;
    };
    CHECK(refusal(three_lights()) == "they are taken");
    CHECK(refusal({{1, 0, 1}, {0, 0, 1}}) == "found 2 lights, expected at least 3");
    CHECK(
        refusal({{1, 0, 1}, {0, 0, 1}, {-1, 0, 1}})
        == "found lights that all lie in one plane, expected three directions");
    CHECK(
        refusal({{1, 0, 1}, {0, 0, 0}, {0, 1, 1}})
        == "light 2: found (0, 0, 0), expected a direction");
    CHECK(
        refusal({{1, 0, 1}, {std::numeric_limits<float>::quiet_NaN(), 0, 0}, {0, 1, 1}})
            .find("light 2: found (nan")
        == 0);
}

TEST_CASE("photometric normals: a pixel in shadow or that is not finite faces the camera, black") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const std::vector<float>& radiance :
         {std::vector<float>{0, 0, 0}, {0.5f, 0.01f, 0.5f}, {0.5f, nan, 0.5f}}) {
        const PhotometricPixel found = solve_photometric(three_lights(), radiance, 0.02f);
        CHECK(found.normal == Vec3(0, 0, 1));
        CHECK(found.reflectance == 0);
    }
}

}  // namespace
}  // namespace limn::photometric_normals_test
