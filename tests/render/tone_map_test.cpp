#include "tests/render/scene_fixture.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <algorithm>

namespace limn::test {
namespace {

double srgb(double x) {
    x = std::clamp(x, 0.0, 1.0);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

/// The curves once more, from their papers.
glm::dvec3 neutral(glm::dvec3 c) {
    const double x = std::min({c.x, c.y, c.z});
    c -= x < 0.08 ? x - 6.25 * x * x : 0.04;
    const double p = std::max({c.x, c.y, c.z});
    if (p < 0.76) {
        return c;
    }
    const double q = 1 - 0.24 * 0.24 / (p + 0.24 - 0.76);
    const double g = 1 / (0.15 * (p - q) + 1);
    return glm::mix(glm::dvec3(q), c * (q / p), g);
}

double hill(double v) {
    return (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
}

glm::dvec3 aces(const glm::dvec3& c) {
    const glm::dmat3 input = glm::transpose(glm::dmat3(
        0.59719, 0.35458, 0.04823, 0.07600, 0.90834, 0.01566, 0.02840, 0.13383, 0.83777));
    const glm::dmat3 output = glm::transpose(glm::dmat3(
        1.60475, -0.53108, -0.07367, -0.10208, 1.10813, -0.00605, -0.00327, -0.07276, 1.07602));
    const glm::dvec3 v = input * c;
    return output * glm::dvec3(hill(v.x), hill(v.y), hill(v.z));
}

struct ToneScene : Scene {
    /// Mean code, 0 .. 255, of a picture that is all of this radiance.
    Vec3 shown(const Vec3& radiance, const Exposure& exposure) {
        world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = radiance});
        world.insert_resource(exposure);
        bytes = gpu::read_bytes(*draw(look({0, 0, 1}, {0, 0, 0}, 64, 64)).display);
        glm::dvec3 sum(0);
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                sum += glm::dvec3(bytes.at(x, y, 0), bytes.at(x, y, 1), bytes.at(x, y, 2));
                CHECK(bytes.at(x, y, 3) == 255);
            }
        }
        return Vec3(sum / 4096.0);
    }
    gpu::ByteImage bytes;
};

const Vec3 kColors[] = {
    {0.02f, 0.05f, 0.01f},
    {0.18f, 0.18f, 0.18f},
    {0.5f, 0.2f, 0.7f},
    {0.9f, 0.3f, 0.1f},
    {2.0f, 1.0f, 0.4f},
    {0.1f, 6.0f, 3.0f},
    {40, 40, 40}};

}  // namespace

TEST_CASE_FIXTURE(
    ToneScene,
    "tone map: linear is exposure, clamp and sRGB, right in the mean to a fifth of a code") {
    for (const float ev : {-2.0f, 0.0f, 1.0f}) {
        for (const Vec3& color : kColors) {
            const Vec3 got = shown(color, {.ev = ev, .curve = ToneCurve::Linear});
            for (int c = 0; c < 3; ++c) {
                const double want = 255 * srgb(color[c] * std::exp2(ev));
                // At the ends dither has nowhere to go.
                CHECK(std::abs(got[c] - want) <= (want < 2 || want > 253 ? 0.6 : 0.2));
            }
        }
    }
}

TEST_CASE_FIXTURE(ToneScene, "tone map: both curves have the values of their papers") {
    for (const Vec3& color : kColors) {
        const Vec3 n = shown(color, {.curve = ToneCurve::Neutral});
        const Vec3 a = shown(color, {.curve = ToneCurve::Aces});
        for (int c = 0; c < 3; ++c) {
            CHECK(std::abs(n[c] - 255 * srgb(neutral(color)[c])) <= 0.7);
            CHECK(std::abs(a[c] - 255 * srgb(aces(color)[c])) <= 0.7);
        }
    }
    // Neutral leaves base colors alone but for 0.04 of haze.
    CHECK(
        shown({0.5f, 0.4f, 0.3f}, {.curve = ToneCurve::Neutral}).x
        == doctest::Approx(255 * srgb(0.46)).epsilon(2e-3));
}

TEST_CASE_FIXTURE(ToneScene, "tone map: brighter never looks darker") {
    for (const ToneCurve curve : {ToneCurve::Neutral, ToneCurve::Aces, ToneCurve::Linear}) {
        float last = -1;
        for (float radiance = 0.001f; radiance < 500; radiance *= 1.3f) {
            const float code = shown(Vec3(radiance), {.curve = curve}).x;
            CHECK(code >= last - 0.2f);
            last = code;
        }
        CHECK(last > 250);
    }
}

TEST_CASE_FIXTURE(ToneScene, "tone map: one stop up is twice the radiance") {
    const Vec3 doubled = shown({0.2f, 0.3f, 0.4f}, {.ev = 1, .curve = ToneCurve::Aces});
    const Vec3 brighter = shown({0.4f, 0.6f, 0.8f}, {.ev = 0, .curve = ToneCurve::Aces});
    CHECK(doubled == brighter);
}

TEST_CASE_FIXTURE(
    ToneScene, "tone map: dither spreads a value over neighboring codes and repeats") {
    const float between = 0.2146f;  // between two codes
    static_cast<void>(shown(Vec3(between), {.curve = ToneCurve::Linear}));
    const gpu::ByteImage first = bytes;
    const double want = 255 * srgb(between);
    bool below = false;
    bool above = false;
    for (const std::uint8_t code : first.pixels) {
        if (code != 255) {
            CHECK(std::abs(code - want) < 2);
            below = below || code < want;
            above = above || code > want;
        }
    }
    CHECK(below);
    CHECK(above);
    static_cast<void>(shown(Vec3(between), {.curve = ToneCurve::Linear}));
    CHECK(first.pixels == bytes.pixels);
}

TEST_CASE_FIXTURE(ToneScene, "tone map: broken and endless radiance ends in the codes") {
    static_cast<void>(shown(Vec3(1e30f), {.ev = 24}));
    CHECK(bytes.at(3, 3, 0) == 255);
    static_cast<void>(shown(Vec3(1), {.ev = -24}));
    CHECK(bytes.at(3, 3, 0) <= 1);
}

}  // namespace limn::test
