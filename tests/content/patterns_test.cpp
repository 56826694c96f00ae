#include "content/make/patterns/bubble_pattern.h"
#include "content/make/patterns/crown_pattern.h"
#include "content/make/patterns/glow_pattern.h"
#include "content/make/patterns/mask_pattern.h"
#include "content/make/patterns/patterns.h"
#include "content/make/patterns/ridge_pattern.h"
#include "content/make/patterns/sclera_pattern.h"
#include "content/make/patterns/sprite_fluid.h"
#include "content/make/patterns/sprite_patterns.h"
#include "ecs/base/hash.h"
#include "ecs/base/jobs.h"
#include "ecs/base/math.h"
#include "ecs/base/srgb.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

namespace limn::patterns_test {
namespace {

/// What a level gets that names a kind and a size.
PatternMaps make_small(const PatternKind& kind, int size, int seed = 1) {
    std::vector<std::byte> bytes(kind.parameters->size);
    kind.parameters->ops.construct_copy(bytes.data(), kind.parameters->defaults, 1);
    for (const FieldInfo& field : kind.parameters->fields) {
        if (std::string(field.name) == "size") {
            *reinterpret_cast<int*>(bytes.data() + field.offset) = size;
        } else if (std::string(field.name) == "seed") {
            *reinterpret_cast<int*>(bytes.data() + field.offset) = seed;
        }
    }
    PatternMaps maps = kind.make(bytes.data());
    kind.parameters->ops.destroy(bytes.data(), 1);
    return maps;
}

int channel(const ImageData& image, int x, int y, int c) {
    return image.pixels[static_cast<std::size_t>(4 * (y * image.width + x) + c)];
}

/// Mean difference of neighbors along `axis` between lines `at` - 1 and `at`, over all channels.
double step_across(const ImageData& image, int axis, int at) {
    double sum = 0;
    const int n = image.width;
    for (int i = 0; i < n; ++i) {
        for (int c = 0; c < 3; ++c) {
            const int before = (at + n - 1) % n;
            const int a = axis == 0 ? channel(image, before, i, c) : channel(image, i, before, c);
            const int b = axis == 0 ? channel(image, at, i, c) : channel(image, i, at, c);
            sum += std::abs(a - b);
        }
    }
    return sum / (3.0 * n);
}

std::uint64_t bits(const PatternMaps& maps) {
    std::uint64_t hash = 0;
    for (const ImageData* image : {&maps.base_color, &maps.normal, &maps.orm}) {
        hash = hash_bytes(image->pixels.data(), image->pixels.size(), hash);
    }
    return hash;
}

/// Without those that make a head first, which takes long: head_furrow_test.cpp and
/// wrinkle_model_test.cpp test them.
std::vector<PatternKind> plain_kinds() {
    std::vector<PatternKind> kinds;
    std::ranges::copy_if(pattern_kinds(), std::back_inserter(kinds), [](const PatternKind& kind) {
        const std::string name = kind.name;
        // Flutes have normals in the space of a mesh (relief_patterns_test).
        return name != "head_furrows" && name != "strain_folds" && name != "flutes";
    });
    return kinds;
}

}  // namespace

TEST_CASE("patterns: every kind makes three complete images of the requested size") {
    REQUIRE(pattern_kinds().size() == 46);
    for (const PatternKind& kind : plain_kinds()) {
        INFO(std::string(kind.name));
        const PatternMaps maps = make_small(kind, 64);
        for (const ImageData* image : {&maps.base_color, &maps.normal, &maps.orm}) {
            CHECK(image->width == 64);
            CHECK(image->height == 64);
            CHECK(image->pixels.size() == 64 * 64 * 4);
        }
        CHECK(maps.base_color.srgb == (std::string(kind.name) != "masks"));
        CHECK(!maps.normal.srgb);
        CHECK(!maps.orm.srgb);
        CHECK(make_small(kind, 1).normal.pixels.size() == 4);
    }
}

TEST_CASE("patterns: frames of a flipbook end before their border, and differ") {
    for (const PatternKind& kind : plain_kinds()) {
        const std::vector<std::string> flipbooks = {
            "bubble", "confetti", "crown", "fire",      "fireball", "flame", "leaf",
            "ring",   "shard",    "smoke", "snowflake", "splash",   "tree"};
        if (std::find(flipbooks.begin(), flipbooks.end(), kind.name) == flipbooks.end()) {
            continue;
        }
        INFO(std::string(kind.name));
        const ImageData image = make_small(kind, 256).base_color;  // 4 x 4 frames
        const auto opacity = [&](int x, int y) {
            return image.pixels[static_cast<std::size_t>(y * 256 + x) * 4 + 3];
        };
        int differences = 0;
        for (int i = 0; i < 256; ++i) {
            for (const int border : {0, 63, 64, 127, 128, 191, 192, 255}) {
                REQUIRE(opacity(border, i) == 0);
                REQUIRE(opacity(i, border) == 0);
            }
            for (int y = 0; y < 64; ++y) {
                differences += std::abs(opacity(i, y) - opacity(i, y + 64)) > 20 ? 1 : 0;
            }
        }
        CHECK(differences > 150);
        for (int frame = 0; frame < 16; ++frame) {
            int most = 0;
            for (int i = 0; i < 64; ++i) {
                for (int x = 0; x < 64; ++x) {
                    most = std::max<int>(most, opacity(frame % 4 * 64 + x, frame / 4 * 64 + i));
                }
            }
            CHECK(most > 120);
        }
    }
}

TEST_CASE("patterns: flames end below the upper edge and repeat without a jump") {
    const ImageData image = make_fire({.image = {.size = 256}}).base_color;
    const auto opacity = [&](int frame, int x, int y) {
        const int at = (frame / 4 * 64 + y) * 256 + frame % 4 * 64 + x;
        return static_cast<int>(image.pixels[static_cast<std::size_t>(at) * 4 + 3]);
    };
    double steps[16] = {};
    double high = 0;
    double low = 0;
    for (int frame = 0; frame < 16; ++frame) {
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                steps[frame] += std::abs(opacity(frame, x, y) - opacity((frame + 1) % 16, x, y));
                (y < 16 ? high : low) += opacity(frame, x, y);
            }
        }
    }
    CHECK(high < 0.15 * low);
    const double most = *std::max_element(steps, steps + 15);
    CHECK(steps[15] < 1.3 * most);
}

TEST_CASE(
    "patterns: a frame of fire moved by its motion map is closer to the next than it was"
    * technique("particle.motion-vectors")) {
    constexpr int kSide = 64;
    for (const char* const name : {"fire", "fireball"}) {
        CAPTURE(name);
        const PatternKind* const kind = find_kind(pattern_kinds(), name);
        REQUIRE(kind->maps == PatternKindMaps::Motion);
        const PatternMaps maps = make_small(*kind, 4 * kSide);
        CHECK(!maps.motion.srgb);
        const auto at = [&](const ImageData& image, int frame, int x, int y, int c) {
            const int column = frame % 4 * kSide + std::clamp(x, 0, kSide - 1);
            return channel(image, column, frame / 4 * kSide + std::clamp(y, 0, kSide - 1), c);
        };
        double still = 0;
        double moved = 0;
        for (int frame = 0; frame < 15; ++frame) {
            for (int y = 0; y < kSide; ++y) {
                for (int x = 0; x < kSide; ++x) {
                    const auto motion = [&](int c) {
                        const int encoded = at(maps.motion, frame, x, y, c);
                        return kMotionRange * kSide * static_cast<float>(encoded - 128) / 127;
                    };
                    // Nearest texel: half a pixel of error at most.
                    const int from_x =
                        static_cast<int>(std::lround(static_cast<float>(x) - motion(0)));
                    const int from_y =
                        static_cast<int>(std::lround(static_cast<float>(y) - motion(1)));
                    const int next = at(maps.base_color, frame + 1, x, y, 3);
                    still += std::abs(next - at(maps.base_color, frame, x, y, 3));
                    moved += std::abs(next - at(maps.base_color, frame, from_x, from_y, 3));
                }
            }
        }
        CHECK(moved < 0.8 * still);
    }
    for (const PatternKind& kind : plain_kinds()) {
        CHECK(make_small(kind, 16).motion.pixels.empty() == (kind.maps != PatternKindMaps::Motion));
    }
}

TEST_CASE("patterns: billows of smoke are lit from above, a veil is white") {
    const ImageData puff = make_smoke({.image = {.size = 256}, .billow = 1}).base_color;
    const ImageData veil = make_smoke({.image = {.size = 256}}).base_color;
    double upper = 0;
    double lower = 0;
    for (int y = 16; y < 48; ++y) {
        for (int x = 16; x < 48; ++x) {
            (y < 32 ? upper : lower) += channel(puff, x, y, 0);
            CHECK(channel(veil, x, y, 1) == 255);
        }
    }
    CHECK(upper > 1.03 * lower);
}

TEST_CASE("patterns: hills close around the horizon; opacity is what the air lets through") {
    constexpr int kSize = 256;
    const ImageData image =
        make_ridges({.image = {.size = kSize}, .crests = 4, .air = 0.6f}).base_color;
    const auto opacity = [&](int x, int y) {
        return image.pixels[static_cast<std::size_t>(4 * (y * kSize + x) + 3)];
    };
    int farthest = 0;
    int steps[2] = {};
    for (int x = 0; x < kSize; ++x) {
        CHECK(opacity(x, 0) == 0);
        CHECK(opacity(x, kSize - 1) == 255);  // the nearest crest, and what is in front of it
        int top = 0;
        while (opacity(x, top) < 51) {  // half covered
            ++top;
        }
        farthest += opacity(x, top + 2) == 102 ? 1 : 0;  // 1 - air
    }
    CHECK(farthest > kSize / 3);
    // The last column goes on in the first.
    for (int y = 0; y < kSize; ++y) {
        steps[0] += std::abs(opacity(0, y) - opacity(kSize - 1, y));
        steps[1] += std::abs(opacity(kSize / 2, y) - opacity(kSize / 2 - 1, y));
    }
    CHECK(steps[0] < 3 * steps[1] + 200);
}

TEST_CASE("patterns: a snow crystal looks alike after a sixth of a turn") {
    const ImageData image = make_snowflake({.image = {.size = 512}, .frames = 1}).base_color;
    const auto opacity = [&](double x, double y) {
        return channel(image, static_cast<int>(256 + x), static_cast<int>(256 + y), 3);
    };
    int different = 0;
    for (int i = 0; i < 2000; ++i) {
        const double radius = 20 + 190 * (i / 2000.0);
        const double angle = 0.37 * i;
        const double turned = angle + 3.14159265 / 3;
        const int a = opacity(radius * std::cos(angle), radius * std::sin(angle));
        const int b = opacity(radius * std::cos(turned), radius * std::sin(turned));
        different += std::abs(a - b) > 60 ? 1 : 0;
    }
    CHECK(different < 40);
}

TEST_CASE("patterns: a glow is half as bright at its core, falls by the square and has no rim") {
    constexpr int kSide = 256;
    const PatternMaps maps = make_glow({.image = {.size = kSide}, .core = 0.1f, .rays = 0});
    const auto light = [&](int x, int y) {
        const std::uint8_t* const p =
            maps.base_color.pixels.data() + static_cast<std::ptrdiff_t>(y * kSide + x) * 4;
        return linear_from_srgb(static_cast<float>(p[0]) / 255.0f) * static_cast<float>(p[3])
               / 255.0f;
    };
    const auto at = [&](float away) {
        return light(static_cast<int>(std::lround(0.5f * kSide * (1.0f + away) - 0.5f)), kSide / 2);
    };
    CHECK(at(0) > 0.97f);
    CHECK(at(0.1f) == test::near(0.5).epsilon(0.06));
    // 1 / (1 + 16) and 1 / (1 + 4), times the end of 0.84^2 and 0.96^2.
    CHECK(at(0.4f) / at(0.2f) == test::near(0.2251).epsilon(0.06));
    for (int x = kSide / 2; x + 1 < kSide; ++x) {
        CAPTURE(x);
        CHECK(light(x + 1, kSide / 2) <= light(x, kSide / 2));
        CHECK(std::abs(light(x, kSide / 2) - light(kSide / 2, x)) < 0.01f);  // all around alike
        if (x > kSide * 85 / 100) {                                          // over the last third
            CHECK(light(x, kSide / 2) < 0.006f);
        }
    }
    // Rays are light beside shade, around a middle that is whole.
    const PatternMaps star = make_glow({.image = {.size = kSide}, .core = 0.1f, .rays = 1});
    const auto opacity = [&](float away, float angle) {
        const float x = 0.5f * kSide * (1.0f + away * std::cos(angle));
        const float y = 0.5f * kSide * (1.0f + away * std::sin(angle));
        return star.base_color
            .pixels[(static_cast<std::size_t>(y) * kSide + static_cast<std::size_t>(x)) * 4 + 3];
    };
    int bright = 0;
    int dark = 0;
    for (int i = 0; i < 360; ++i) {
        const float angle = radians(static_cast<float>(i));
        bright += opacity(0.4f, angle) > 70 ? 1 : 0;
        dark += opacity(0.4f, angle) < 30 ? 1 : 0;
        CHECK(opacity(0.01f, angle) > 220);
    }
    CHECK(bright > 10);
    CHECK(dark > 90);
}

TEST_CASE("patterns: a crown widens from frame to frame, rises, and falls back to its foot") {
    constexpr int kFrames = 4;
    constexpr int kFrame = 128;
    const PatternMaps maps = make_crown({.image = {.size = kFrame * kFrames}, .frames = kFrames});
    std::vector<int> tops;
    std::vector<int> widths;
    for (int frame = 0; frame < kFrames * kFrames; ++frame) {
        int top = kFrame;
        int bottom = 0;
        int left = kFrame;
        int right = 0;
        for (int y = 0; y < kFrame; ++y) {
            for (int x = 0; x < kFrame; ++x) {
                const int row = frame / kFrames * kFrame + y;
                const int column = frame % kFrames * kFrame + x;
                if (maps.base_color.pixels
                        [(static_cast<std::size_t>(row) * kFrame * kFrames
                          + static_cast<std::size_t>(column))
                             * 4
                         + 3]
                    > 40) {
                    top = std::min(top, y);
                    bottom = std::max(bottom, y);
                    left = std::min(left, x);
                    right = std::max(right, x);
                }
            }
        }
        tops.push_back(kFrame - top);
        widths.push_back(right - left);
        if (frame < 6) {  // the foot: a tenth of the frame above its lower edge
            CHECK(bottom > kFrame * 82 / 100);
            CHECK(bottom < kFrame * 98 / 100);
        }
    }
    for (std::size_t i = 1; i < widths.size(); ++i) {
        CAPTURE(i);
        CHECK(widths[i] >= widths[i - 1] - 3);
    }
    const auto highest = std::max_element(tops.begin(), tops.end());
    CHECK(highest > tops.begin() + 4);
    CHECK(highest < tops.end() - 2);
    CHECK(tops.front() < *highest / 2);
    CHECK(tops.back() < *highest - 8);
}

TEST_CASE("patterns: a bubble has total reflection beyond the critical angle, mirrors the sky, and "
          "is clear inside") {
    constexpr int kSide = 512;
    constexpr float kRadius = 0.4f * kSide;
    const ImageData image =
        make_bubble({.image = {.size = kSide}, .frames = 1, .flatness = 0}).base_color;
    const auto texel = [&](float radius, float angle) {
        const int x = static_cast<int>(0.5f * kSide + kRadius * radius * std::cos(angle));
        const int y = static_cast<int>(0.5f * kSide - kRadius * radius * std::sin(angle));
        return &image.pixels[static_cast<std::size_t>(y * kSide + x) * 4];
    };
    // By Snell: light from water to air is refracted up to this share of the radius.
    constexpr float kCritical = 1.0f / 1.333f;
    for (int i = 0; i < 360; i += 5) {
        CAPTURE(i);
        const float angle = radians(static_cast<float>(i));
        CHECK(texel(kCritical + 0.03f, angle)[3] > 250);
        CHECK(texel(kCritical - 0.1f, angle)[3] < 60);
        CHECK(texel(0.3f, angle)[3] < 0.021f * 255 + 1);  // ((n - 1) / (n + 1))^2 in the middle
        CHECK(texel(1.05f, angle)[3] == 0);
    }
    // A mirror at 50 degrees shows what is 80 degrees from straight ahead.
    CHECK(texel(0.77f, radians(90.0f))[0] > 250);
    CHECK(texel(0.77f, radians(270.0f))[0] < 120);
    for (int i = 0; i < 90; i += 10) {
        const float angle = radians(static_cast<float>(i));
        CHECK(std::abs(texel(0.8f, angle)[0] - texel(0.8f, kPi - angle)[0]) <= 6);
    }
}

TEST_CASE("fluid: pressure removes the divergence, heat rises, cools and spreads by expansion") {
    const auto run = [](float expansion, int steps) {
        FluidGrid fluid = make_fluid(48);
        for (int y = 20; y < 28; ++y) {
            for (int x = 20; x < 28; ++x) {
                fluid.heat[fluid.at(x, y)] = fluid.soot[fluid.at(x, y)] = 1;
            }
        }
        FluidStep step;
        step.expansion = expansion;
        for (int i = 0; i < steps; ++i) {
            step_fluid(fluid, step);
        }
        return fluid;
    };
    struct Moments {
        double sum = 0;
        double height = 0;
        double radius2 = 0;
    };
    const auto moments = [](const FluidGrid& fluid, const std::vector<float>& field) {
        Moments m;
        for (int y = 0; y < 48; ++y) {
            for (int x = 0; x < 48; ++x) {
                const double value = static_cast<double>(field[fluid.at(x, y)]);
                m.sum += value;
                m.height += value * y;
                m.radius2 += value * (x - 23.5) * (x - 23.5);
            }
        }
        m.height /= m.sum;
        m.radius2 /= m.sum;
        return m;
    };
    const FluidGrid still = run(0, 12);
    CHECK(largest_divergence(still) < 6.0f);  // [1/s], where v / cell is about 50
    const Moments heat = moments(still, still.heat);
    const Moments soot = moments(still, still.soot);
    CHECK(soot.height > 24.5);
    CHECK(soot.sum == test::near(64).epsilon(0.2));
    CHECK(heat.sum < 0.95 * soot.sum);
    const FluidGrid burst = run(20, 6);
    CHECK(moments(burst, burst.soot).radius2 > 1.5 * moments(run(0, 6), run(0, 6).soot).radius2);
}

TEST_CASE(
    "patterns: masks are 1 inside, 0 outside, and their sum is at most 1"
    * technique("wrinkle.maps.masks")) {
    MasksPattern pattern;
    pattern.image.size = 64;
    pattern.regions = {{0, {0.3f, 0.5f}, {0.25f, 0.25f}}, {3, {0.6f, 0.5f}, {0.25f, 0.25f}}};
    const ImageData masks = make_masks(pattern).base_color;
    CHECK(channel(masks, 16, 32, 0) == 255);
    CHECK(channel(masks, 16, 32, 3) == 0);
    CHECK(channel(masks, 42, 32, 3) == 255);
    int shared = 0;
    for (int i = 0; i < 64 * 64; ++i) {
        int sum = 0;
        for (int k = 0; k < 4; ++k) {
            sum += channel(masks, i % 64, i / 64, k);
        }
        CHECK(sum <= 255);
        CHECK(channel(masks, i % 64, i / 64, 1) == 0);
        shared += channel(masks, i % 64, i / 64, 0) > 0 && channel(masks, i % 64, i / 64, 3) > 0;
    }
    CHECK(shared > 20);
    CHECK(channel(masks, 2, 2, 0) == 0);
}

TEST_CASE("patterns: vessels redden the white of an eye from its corners, and leave out the iris") {
    ScleraPattern pattern;
    pattern.image.size = 256;
    pattern.redness = 1;
    const ImageData image = make_sclera(pattern).base_color;
    int crossed = 0;     // rows of the white beside the iris that a vessel crosses
    double red[2] = {};  // sum of how much redder than white, at the sides, above and below
    for (int y = 0; y < 256; ++y) {
        bool vessel = false;
        for (int x = 0; x < 256; ++x) {
            const Vec2 p = (Vec2(x, y) + 0.5f) / 128.0f - 1.0f;
            const int more = channel(image, x, y, 0) - channel(image, x, y, 1);
            CHECK(more >= 0);
            if (glm::length(p) < 0.5f || glm::length(p) > 1.1f) {
                CHECK(channel(image, x, y, 1) == 255);
            } else if (std::abs(p.x) != std::abs(p.y)) {
                red[std::abs(p.x) > std::abs(p.y) ? 0 : 1] += more;
            }
            vessel |= glm::length(p) < 0.85f && more > 60;
        }
        crossed += vessel ? 1 : 0;
    }
    CHECK(red[0] > 3 * red[1]);
    CHECK(crossed > 60);
    pattern.redness = 0;
    const ImageData white = make_sclera(pattern).base_color;
    CHECK(std::ranges::all_of(white.pixels, [](std::uint8_t value) { return value == 255; }));
}

TEST_CASE("patterns: images tile without a seam") {
    for (const PatternKind& kind : plain_kinds()) {
        INFO(std::string(kind.name));
        const PatternMaps maps = make_small(kind, 192);
        for (const ImageData* image : {&maps.base_color, &maps.normal, &maps.orm}) {
            for (const int axis : {0, 1}) {
                if (axis == 1 && kind.name == std::string("ridges")) {
                    continue;  // from the ground to the sky
                }
                double most = 0;
                for (int line = 1; line < 192; ++line) {
                    most = std::max(most, step_across(*image, axis, line));
                }
                CHECK(step_across(*image, axis, 0) <= 1.25 * most + 1.0);
            }
        }
    }
}

TEST_CASE(
    "patterns: a bump at one edge of the image bends the normals at the other"
    * technique("bump.nm-from-height")) {
    const PatternMaps maps = make_pattern_maps(32, [](const Vec2& uv) {
        return PatternTexel{.height = uv.x < 1.0f / 32 || uv.y < 1.0f / 32 ? 0.02f : 0.0f};
    });
    CHECK(channel(maps.normal, 31, 16, 0) < 120);  // it rises to the right, into column 0
    CHECK(channel(maps.normal, 16, 31, 1) > 136);  // and downwards, into row 0
    CHECK(channel(maps.normal, 16, 16, 0) == 128);
}

TEST_CASE("patterns: a brick that is cut by the edge of the image continues at the opposite edge") {
    const PatternMaps wall = make_bricks({.image = {.size = 256}, .variation = 1});
    double seam = 0;
    double joint = 0;
    for (int row = 1; row < 8; row += 2) {  // every other row begins with half a brick
        const int y = 32 * row + 16;
        for (int c = 0; c < 3; ++c) {
            seam +=
                std::abs(channel(wall.base_color, 255, y, c) - channel(wall.base_color, 0, y, c));
            joint +=
                std::abs(channel(wall.base_color, 4, y, c) - channel(wall.base_color, 60, y, c));
        }
    }
    CHECK(seam < 0.5 * joint);
}

TEST_CASE(
    "patterns: normals are unit, point outwards and have no bias"
    * technique("bump.nm-from-height")) {
    for (const PatternKind& kind : plain_kinds()) {
        INFO(std::string(kind.name));
        const PatternMaps maps = make_small(kind, 128);
        glm::dvec3 sum(0);
        for (int y = 0; y < 128; ++y) {
            for (int x = 0; x < 128; ++x) {
                const Vec3 n = Vec3(
                                   channel(maps.normal, x, y, 0), channel(maps.normal, x, y, 1),
                                   channel(maps.normal, x, y, 2))
                                   / 127.5f
                               - 1.0f;
                REQUIRE(glm::length(n) == test::near(1.0f).epsilon(0.02));
                REQUIRE(n.z > 0);
                sum += glm::dvec3(n);
            }
        }
        CHECK(std::abs(sum.x) < 0.01 * sum.z);
        CHECK(std::abs(sum.y) < 0.01 * sum.z);
    }
}

TEST_CASE(
    "patterns: red points right and green up where the surface falls that way"
    * technique("bump.nm-from-height")) {
    const PatternMaps right = make_pattern_maps(
        64, [](const Vec2& uv) { return PatternTexel{.height = -0.5f * std::abs(uv.x - 0.5f)}; });
    CHECK(channel(right.normal, 48, 32, 0) > 160);  // right half: falls to the right
    CHECK(channel(right.normal, 16, 32, 0) < 96);
    CHECK(std::abs(channel(right.normal, 48, 32, 1) - 128) <= 1);
    const PatternMaps up = make_pattern_maps(
        64, [](const Vec2& uv) { return PatternTexel{.height = -0.5f * std::abs(uv.y - 0.5f)}; });
    CHECK(channel(up.normal, 32, 16, 1) > 160);  // upper half: falls to the top
    CHECK(channel(up.normal, 32, 48, 1) < 96);
    // A slope of 1/2: the normal is (0, 1, 2) / sqrt(5).
    CHECK(
        channel(up.normal, 32, 16, 1)
        == test::near(127.5 * (1 + 1 / std::sqrt(5.0))).epsilon(0.01));
}

TEST_CASE(
    "patterns: a slope has the normal of its formula, whatever the height it is at"
    * technique("bump.nm-from-height, bump.normal-encoding")) {
    // Bytes of (-right, -up, 1), made unit, and halfway from the edges, where heights jump.
    const auto normal_of = [](float right, float up, float raised) {
        const PatternMaps maps = make_pattern_maps(32, [&](const Vec2& uv) {
            return PatternTexel{.height = right * uv.x - up * uv.y + raised};
        });
        std::array<int, 3> bytes = {};
        for (int c = 0; c < 3; ++c) {
            bytes[static_cast<std::size_t>(c)] = channel(maps.normal, 16, 16, c);
        }
        return bytes;
    };
    using Bytes = std::array<int, 3>;
    CHECK(normal_of(0, 0, 0) == Bytes{128, 128, 255});
    CHECK(normal_of(1, 0, 0) == Bytes{37, 128, 218});
    CHECK(normal_of(0.5f, 0, 0) == Bytes{70, 128, 242});
    CHECK(normal_of(0, -1, 0) == Bytes{128, 218, 218});
    CHECK(normal_of(1, 1, 0) == Bytes{54, 54, 201});
    CHECK(normal_of(1, 1, 2) == normal_of(1, 1, 0));
    CHECK(normal_of(-1, -1, 0) == Bytes{201, 201, 201});
}

TEST_CASE("patterns: the values of a texel are in the right channels") {
    const PatternMaps maps = make_pattern_maps(2, [](const Vec2& uv) {
        return PatternTexel{
            .color = {1, 0.2159f, uv.x < 0.5f ? 0.0f : 1.0f},
            .roughness = 0.4f,
            .metalness = 1,
            .occlusion = 0.2f};
    });
    CHECK(channel(maps.base_color, 0, 0, 0) == 255);
    CHECK(channel(maps.base_color, 0, 0, 1) == 128);  // sRGB 0.502
    CHECK(channel(maps.base_color, 0, 0, 2) == 0);
    CHECK(channel(maps.base_color, 1, 1, 2) == 255);
    CHECK(channel(maps.orm, 0, 1, 0) == 51);
    CHECK(channel(maps.orm, 0, 1, 1) == 102);
    CHECK(channel(maps.orm, 0, 1, 2) == 255);
}

TEST_CASE("patterns: the same parameters give the same pixels on any number of threads, another "
          "seed others") {
    const int threads = thread_count();
    for (const PatternKind& kind : plain_kinds()) {
        INFO(std::string(kind.name));
        set_thread_count(1);
        const std::uint64_t one = bits(make_small(kind, 64));
        set_thread_count(3);
        CHECK(bits(make_small(kind, 64)) == one);
        CHECK(bits(make_small(kind, 64, 2)) != one);
    }
    set_thread_count(threads);
}

TEST_CASE("patterns: metals are metal, rust is not, and everything else is no metal at all") {
    for (const PatternKind& kind : plain_kinds()) {
        INFO(std::string(kind.name));
        const PatternMaps maps = make_small(kind, 128);
        double metal = 0;
        for (int i = 0; i < 128 * 128; ++i) {
            metal += channel(maps.orm, i % 128, i / 128, 2) / 255.0 / (128 * 128);
        }
        const std::string name = kind.name;
        if (name == "brushed_metal") {
            CHECK(metal == test::near(1.0));
        } else if (name == "rust") {
            CHECK(metal > 0.2);
            CHECK(metal < 0.8);
        } else {
            CHECK(metal == 0);
        }
    }
}

TEST_CASE(
    "patterns: half of a plain weave is warp, two thirds of a twill in diagonals, all of a knit") {
    constexpr int kThreads = 12;
    constexpr int kTexels = 10;  // of a thread
    const auto warp_at = [](const PatternMaps& maps, int column, int row) {
        const int x = (column % kThreads) * kTexels + kTexels / 2;
        const int y = (row % kThreads) * kTexels + kTexels / 2;
        return channel(maps.base_color, x, y, 0) > channel(maps.base_color, x, y, 1);
    };
    const auto weave = [](FabricWeave kind) {
        return make_fabric(
            {.image = {.size = kThreads * kTexels},
             .weave = kind,
             .threads = kThreads,
             .warp_color = {1, 0, 0},
             .weft_color = {0, 1, 0}});
    };
    const auto count = [&](const PatternMaps& maps) {
        int warps = 0;
        for (int i = 0; i < kThreads * kThreads; ++i) {
            warps += warp_at(maps, i % kThreads, i / kThreads) ? 1 : 0;
        }
        return warps;
    };
    const PatternMaps twill = weave(FabricWeave::Twill);
    CHECK(count(weave(FabricWeave::Plain)) == kThreads * kThreads / 2);
    CHECK(count(twill) == kThreads * kThreads * 2 / 3);
    CHECK(count(weave(FabricWeave::Knit)) == kThreads * kThreads);
    for (int i = 0; i < kThreads * kThreads; ++i) {
        const int column = i % kThreads;
        const int row = i / kThreads;
        CHECK(warp_at(twill, column, row) == warp_at(twill, column + 1, row + kThreads - 1));
    }
}

TEST_CASE("patterns: kinds are found by name, and the error for a typo suggests the nearest") {
    REQUIRE(find_kind(pattern_kinds(), "marble") != nullptr);
    CHECK(find_kind(pattern_kinds(), "Marble") == nullptr);
    CHECK(kind_suggestion(pattern_kinds(), "marbel") == " (did you mean marble?)");
    for (const PatternKind& kind : plain_kinds()) {
        CHECK(kind.parameters->fields.size() >= 3);
    }
}

}  // namespace limn::patterns_test
