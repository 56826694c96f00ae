#include "ecs/components/all.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "tests/near.h"
#include "tests/render/particle_fixture.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace limn::test::particle_flipbook_test {
namespace {

constexpr int kFrame = 64;         // pixels of a side, of the image drawn too
constexpr float kRadius = 13;      // of the disc [px]
constexpr Vec2 kStart = {20, 20};  // its center in the first frame [px], y downward
constexpr Vec2 kMove = {9, 6};     // from frame to frame [px]: its edge passes over itself
constexpr Vec3 kMiddle[] = {{0, 0, 0}};
constexpr float kStrength = 0.25f;  // of the motion map, in frames

/// Opacity of the disc about `center`, which falls over six pixels.
float disc_at(const Vec2& center, const Vec2& pixel) {
    return 1 - glm::smoothstep(kRadius - 3, kRadius + 3, glm::distance(center, pixel));
}

template <typename Texel>
ImageData make_image(Texel&& texel) {
    ImageData image;
    image.width = image.height = 2 * kFrame;
    image.srgb = false;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const int frame = 2 * (y / kFrame) + x / kFrame;
            const Vec2 at = Vec2(x % kFrame, y % kFrame) + 0.5f;
            for (const float value : texel(frame, at)) {
                image.pixels.push_back(static_cast<std::uint8_t>(std::lround(255 * value)));
            }
        }
    }
    return image;
}

/// A flipbook of two by two frames in which a white disc flies, drawn over the whole image.
struct FlipbookScene : Scene {
    ParticleLook look_;
    Entity particle{};

    FlipbookScene() {
        world.insert_resource(FrameTime{});
        look_.image = add(make_image([](int frame, const Vec2& at) {
            const float opacity = disc_at(kStart + static_cast<float>(frame) * kMove, at);
            return std::array<float, 4>{1, 1, 1, opacity};
        }));
        look_.motion = add(make_image([](int, const Vec2&) {
            const Vec2 encoded =
                (128.0f + 127.0f * kMove / (kStrength * static_cast<float>(kFrame))) / 255.0f;
            return std::array<float, 4>{encoded.x, encoded.y, 0, 1};
        }));
        look_.columns = look_.rows = 2;
        look_.motion_strength = kStrength;
        look_.size = 2;
        look_.emission = 1;
        look_.lit = 0;
        look_.softness = 0;
        look_.turn_spread = 0;
    }
    /// The image `shown` frames after the first, from `away` [m].
    gpu::FloatImage draw(float shown, float away) {
        look_.frame_rate = 2 * shown;
        ParticlePool pool = pool_at(kMiddle);
        const Entity emitter = world.create(ParticleEmitter{}, look_, pool);
        gpu::FloatImage image = radiance(look({0, 0, away}, {0, 0, 0}, kFrame, kFrame));
        world.destroy(emitter);
        return image;
    }
    /// Largest difference from a disc about where it is in frame `shown`, which need not be whole.
    float worst(float shown) {
        const gpu::FloatImage image = draw(shown, 1);
        float most = 0;
        for (int y = 0; y < kFrame; ++y) {
            for (int x = 0; x < kFrame; ++x) {
                const float want = disc_at(kStart + shown * kMove, Vec2(x, y) + 0.5f);
                most = std::max(most, std::abs(rgb_at(image, x, y).x - want));
            }
        }
        return most;
    }
};

}  // namespace

TEST_CASE_FIXTURE(
    FlipbookScene, "particle flipbook: between frames a moving disc is one disc on its path"
                       * technique("particle.motion-vectors")) {
    for (const float shown : {0.25f, 0.5f, 0.9f, 1.0f, 1.5f, 2.3f}) {
        CAPTURE(shown);
        CHECK(worst(shown) < 0.03f);
    }
    // Without its motion two discs fade into each other, with another strength they do not meet.
    ParticleLook& look = look_;
    look.motion_strength = 0.5f * kStrength;
    CHECK(worst(1.5f) > 0.2f);
    look.motion = {};
    CHECK(worst(1.5f) > 0.3f);
    CHECK(worst(1) < 0.03f);
}

TEST_CASE_FIXTURE(
    FlipbookScene, "particle flipbook: quads without what is transparent show what whole ones do") {
    look_.motion_strength = 0;
    const ImageId still = look_.motion;
    // Both quads have other corners: hardware snaps them to 1/256 of a pixel, and weighs texels in
    // as many steps.
    const float bound = device().caps().software ? 0.004f : 3.0f / 256;
    for (const float angle : {0.0f, 1.0f}) {
        for (const float away : {0.7f, 1.0f, 3.0f, 9.0f}) {
            for (const float shown : {0.0f, 0.5f, 1.25f, 3.0f}) {
                look_.turn_spread = angle;
                look_.motion = {};
                const gpu::FloatImage trimmed = draw(shown, away);
                look_.motion = still;  // which may show any part of the frame
                const gpu::FloatImage whole = draw(shown, away);
                float most = 0;
                float sum = 0;
                for (int y = 0; y < kFrame; ++y) {
                    for (int x = 0; x < kFrame; ++x) {
                        const float want = rgb_at(whole, x, y).x;
                        most = std::max(most, std::abs(rgb_at(trimmed, x, y).x - want));
                        sum += want;
                    }
                }
                CAPTURE(angle);
                CAPTURE(away);
                CAPTURE(shown);
                CHECK(sum > 1);
                CHECK(most < bound);
            }
        }
    }
}

TEST_CASE_FIXTURE(
    FlipbookScene, "particle flipbook: a motion map that is missing, or of a disc, changes nothing"
                       * technique("particle.motion-vectors")) {
    look_.motion_strength = 0;
    const float still = worst(1.5f);
    look_.motion_strength = kStrength;
    look_.motion = {999};
    CHECK(worst(1.5f) == near(static_cast<double>(still)));
    look_.image = {};
    look_.motion = {1};
    const float disc = worst(1.5f);
    look_.motion = {};
    CHECK(worst(1.5f) == near(static_cast<double>(disc)));
}

}  // namespace limn::test::particle_flipbook_test
