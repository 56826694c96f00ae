#include "ecs/base/optics.h"
#include "tests/near.h"
#include "tests/render/shader_eval.h"
#include "tests/technique.h"

#include <cmath>
#include <random>

namespace limn::test::optics_test {
namespace {

constexpr float kWater = 1.33f;
constexpr float kIntoWater = 1 / 1.33f;
constexpr Vec3 kUp = {0, 1, 0};

/// Toward light that falls in at `angle` [deg] from straight above, from +x.
Vec3 light_at(float angle) {
    return {std::sin(radians(angle)), std::cos(radians(angle)), 0};
}

float fresnel_at(float angle, float index = kWater) {
    return fresnel(std::cos(radians(angle)), index);
}

float tso_barsky_at(float angle) {
    return fresnel_tso_barsky(std::cos(radians(angle)));
}

Vec3 random_direction(std::mt19937& random) {
    std::normal_distribution<float> normal;
    return glm::normalize(Vec3(normal(random), normal(random), normal(random)));
}

/// What the book writes down, in double precision; not at 0.
double fresnel_of_book(double angle, double index) {
    const double beyond = std::asin(std::sin(angle) / index);
    const auto ratio = [&](double (*f)(double)) {
        const double r = f(angle - beyond) / f(angle + beyond);
        return r * r;
    };
    return 0.5 * (ratio(std::sin) + ratio(std::tan));
}

}  // namespace

TEST_CASE(
    "optics: light along the normal is refracted straight on and reflected straight back"
    * technique("water.snell-vectors")) {
    CHECK(reflect_ray(kUp, kUp) == kUp);
    CHECK(glm::distance(refract_ray(kUp, kUp, kIntoWater), -kUp) < 1e-6f);
}

TEST_CASE(
    "optics: light entering water bends toward the normal by Snell's law"
    * technique("water.snell-vectors")) {
    const float pairs[][2] = {{30, 22.0824f}, {45, 32.1176f}, {60, 40.6281f}};
    for (const auto& pair : pairs) {
        const Vec3 t = refract_ray(kUp, light_at(pair[0]), kIntoWater);
        CHECK(degrees(std::atan2(-t.x, -t.y)) == test::near(pair[1]).epsilon(1e-6));
        const Vec3 r = reflect_ray(kUp, light_at(pair[0]));
        CHECK(degrees(std::atan2(-r.x, r.y)) == test::near(pair[0]).epsilon(1e-6));
    }
}

TEST_CASE("optics: beyond 48.75 degrees no light leaves water" * technique("water.snell-vectors")) {
    CHECK(glm::length(refract_ray(kUp, light_at(48.74f), kWater)) == test::near(1));
    CHECK(refract_ray(kUp, light_at(48.77f), kWater) == Vec3(0));
    CHECK(fresnel_at(48.77f, 1 / kWater) == 1.0f);
    CHECK(fresnel_at(48.5f, 1 / kWater) < 0.7f);
}

TEST_CASE(
    "optics: rays are unit, in one plane, and reversible" * technique("water.snell-vectors")) {
    std::mt19937 random(3);
    for (int i = 0; i < 500; ++i) {
        const Vec3 normal = random_direction(random);
        Vec3 light = random_direction(random);
        light = glm::dot(light, normal) < 0 ? -light : light;
        const Vec3 r = reflect_ray(normal, light);
        const Vec3 t = refract_ray(normal, light, kIntoWater);
        CHECK(glm::length(r) == test::near(1));
        CHECK(glm::length(t) == test::near(1));
        CHECK(std::abs(glm::dot(glm::cross(normal, light), r)) < 1e-6f);
        CHECK(std::abs(glm::dot(glm::cross(normal, light), t)) < 1e-6f);
        const float sine_in = glm::length(glm::cross(normal, light));
        CHECK(glm::length(glm::cross(normal, t)) == test::near(sine_in / kWater));
        // From below, where it went, it comes out where it came from.
        CHECK(glm::distance(refract_ray(normal, t, kWater), light) < 1e-3f);
        CHECK(glm::distance(reflect_ray(normal, r), light) < 1e-6f);
        CHECK(refract_ray(-normal, light, kIntoWater) == t);
    }
}

TEST_CASE(
    "optics: without a boundary light goes straight on and nothing is reflected"
    * technique("water.snell-vectors")) {
    for (const float angle : {0.0f, 30.0f, 80.0f, 89.9f}) {
        CHECK(glm::distance(refract_ray(kUp, light_at(angle), 1), -light_at(angle)) < 1e-6f);
        CHECK(fresnel_at(angle, 1) < 1e-6f);
    }
    CHECK(fresnel(0, 1) == 0.0f);
}

TEST_CASE("optics: water reflects by Fresnel's law" * technique("water.fresnel")) {
    CHECK(fresnel(1, kWater) == test::near(0.0200593).epsilon(1e-5));
    CHECK(fresnel(1, 1.3f) == test::near(0.0170132).epsilon(1e-5));
    const double pairs[][2] = {{30, 0.0211125}, {45, 0.0275214}, {53.06123, 0.0385538},
                               {60, 0.0591256}, {75, 0.211427},  {85, 0.582728}};
    for (const auto& pair : pairs) {
        CHECK(fresnel_at(static_cast<float>(pair[0])) == test::near(pair[1]).epsilon(1e-4));
    }
    CHECK(fresnel(0, kWater) == 1.0f);
    CHECK(fresnel(-0.1f, kWater) == 1.0f);
    CHECK(fresnel(1.1f, kWater) == fresnel(1, kWater));
}

TEST_CASE(
    "optics: the form with cosines equals the one with angles, and is monotonic"
    * technique("water.fresnel")) {
    float last = fresnel(1, kWater);
    for (int i = 1; i <= 890; ++i) {
        const float angle = 0.1f * static_cast<float>(i);
        const float reflectance = fresnel_at(angle);
        const double exact = fresnel_of_book(
            static_cast<double>(angle) * 3.14159265358979 / 180, static_cast<double>(kWater));
        CHECK(std::abs(static_cast<double>(reflectance) - exact) < 3e-6);
        CHECK(reflectance >= last - 1e-7f);
        last = reflectance;
    }
}

TEST_CASE(
    "optics: both sides of a boundary reflect equally along the same ray"
    * technique("water.fresnel")) {
    for (const float angle : {0.0f, 20.0f, 50.0f, 80.0f}) {
        const Vec3 t = refract_ray(kUp, light_at(angle), kIntoWater);
        CHECK(fresnel(-t.y, 1 / kWater) == test::near(fresnel_at(angle)).epsilon(1e-4));
    }
}

TEST_CASE(
    "optics: the book's cheap form has its printed values, its kink and its error"
    * technique("water.fresnel-approx")) {
    CHECK(tso_barsky_at(44.9f) == 0.02f);
    CHECK(tso_barsky_at(45) == test::near(0.02));
    CHECK(tso_barsky_at(60) == test::near(0.128889).epsilon(1e-5));
    CHECK(tso_barsky_at(75) == test::near(0.455556).epsilon(1e-5));
    CHECK(fresnel_tso_barsky(0) == test::near(1.0));
    CHECK(fresnel_tso_barsky(-0.5f) == fresnel_tso_barsky(0));
    // (R - 0.02) / (angle - pi/4)^2 is 392 / (25 pi^2) everywhere, so that it begins without a
    // kink.
    for (const float angle : {50.0f, 70.0f, 88.0f}) {
        const float coefficient = (tso_barsky_at(angle) - 0.02f) / square(radians(angle - 45));
        CHECK(coefficient == test::near(1.588716).epsilon(1e-4));
    }
    float most = 0;
    float where = 0;
    float least = 0;
    for (int i = 0; i < 9000; ++i) {
        const float angle = 0.01f * static_cast<float>(i);
        const float error = tso_barsky_at(angle) - fresnel_at(angle);
        if (error > most) {
            most = error;
            where = angle;
        }
        least = std::min(least, error);
        if (std::abs(angle - 50.33f) > 0.02f) {
            CHECK((error < 0) == (angle < 50.33f));
        }
    }
    CHECK(most == test::near(0.266238).epsilon(1e-5));
    CHECK(where == test::near(79.52).epsilon(1e-3));
    CHECK(least == test::near(-0.007956).epsilon(1e-3));
}

TEST_CASE("optics: Schlick's form is exact at both ends and closer than the book's in between") {
    CHECK(fresnel_schlick(1, kWater) == test::near(fresnel(1, kWater)));
    CHECK(fresnel_schlick(0, kWater) == test::near(1));
    float most = 0;
    for (int i = 0; i <= 900; ++i) {
        const float cosine = std::cos(radians(0.1f * static_cast<float>(i)));
        most = std::max(most, std::abs(fresnel_schlick(cosine, kWater) - fresnel(cosine, kWater)));
    }
    CHECK(most == test::near(0.0599).epsilon(1e-3));
}

TEST_CASE_FIXTURE(
    RenderTest, "optics: the GLSL functions equal the C++ ones"
                    * technique("water.fresnel, water.fresnel-approx, water.snell-vectors")) {
    std::mt19937 random(8);
    std::uniform_real_distribution<float> uniform;
    std::vector<Vec4> inputs;
    for (int i = 0; i < 1000; ++i) {
        inputs.emplace_back(random_direction(random), 0.5f + 1.5f * uniform(random));
    }
    const std::string include = "#include \"lib/optics.glsl\"\n";
    const auto rays = evaluate_shader(
        include,
        "vec3 n = normalize(vec3(0.2, 0.9, -0.4));\n"
        "y = vec4(refract_ray(n, x.xyz, x.w), dot(reflect_ray(n, x.xyz), vec3(1.0, 2.0, 3.0)));",
        inputs);
    const auto reflectances = evaluate_shader(
        include,
        "y = vec4(fresnel(x.x, x.w), fresnel_schlick(x.x, x.w), fresnel_tso_barsky(x.x), 0.0);",
        inputs);
    const Vec3 normal = glm::normalize(Vec3(0.2f, 0.9f, -0.4f));
    int mirrored = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const Vec3 light(inputs[i]);
        const Vec3 t = refract_ray(normal, light, inputs[i].w);
        const float away_from_limit =
            std::abs(1 - square(inputs[i].w) * (1 - square(glm::dot(normal, light))));
        if (away_from_limit > 1e-4f) {
            CHECK(glm::distance(Vec3(rays[i]), t) < 1e-4f);
        }
        mirrored += t == Vec3(0) ? 1 : 0;
        CHECK(
            rays[i].w
            == test::near(glm::dot(reflect_ray(normal, light), Vec3(1, 2, 3)))
                   .epsilon(1e-5)
                   .scale(1));
        CHECK(std::abs(reflectances[i].x - fresnel(light.x, inputs[i].w)) < 1e-3f);
        CHECK(std::abs(reflectances[i].y - fresnel_schlick(light.x, inputs[i].w)) < 1e-5f);
        // The arc cosine of shaders is off by as much as 3e-4.
        CHECK(std::abs(reflectances[i].z - fresnel_tso_barsky(light.x)) < 4e-4f);
    }
    CHECK(mirrored > 50);
}

}  // namespace limn::test::optics_test
