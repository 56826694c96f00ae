#include "content/bake/cone_map.h"
#include "content/bake/relief_map.h"
#include "ecs/base/jobs.h"
#include "ecs/base/math.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

namespace limn::cone_map_test {
namespace {

template <typename Depth>
BakedMap make_depths(int width, int height, Depth&& depth) {
    BakedMap map = make_baked_map(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(width);
            const float v = (static_cast<float>(y) + 0.5f) / static_cast<float>(height);
            map.texels[map.at(x, y)] = {0.5f, 0.5f, 1, std::clamp(depth(u, v), 0.0f, 1.0f)};
        }
    }
    return map;
}

float pyramid(float u, float v) {
    return std::max(std::abs(2 * u - 1), std::abs(2 * v - 1));
}

float bumps(float u, float v) {
    return 0.5f + 0.3f * std::sin(2 * kPi * (2 * u + v)) + 0.2f * std::cos(2 * kPi * (3 * v - u));
}

/// Two posts that stand apart, on a floor.
float posts(float u, float v) {
    const bool in_post =
        std::abs(v - 0.5f) < 0.2f && (std::abs(u - 0.3f) < 0.08f || std::abs(u - 0.7f) < 0.08f);
    return in_post ? 0.1f : 0.9f;
}

/// Bilinear depth, texture coordinates.
double depth_at(const BakedMap& map, bool repeats, double u, double v) {
    const double x = u * map.width - 0.5;
    const double y = v * map.height - 0.5;
    const auto texel = [&](double i, double j) {
        int a = static_cast<int>(i);
        int b = static_cast<int>(j);
        if (repeats) {
            a = ((a % map.width) + map.width) % map.width;
            b = ((b % map.height) + map.height) % map.height;
        } else {
            a = std::clamp(a, 0, map.width - 1);
            b = std::clamp(b, 0, map.height - 1);
        }
        return static_cast<double>(map.texels[map.at(a, b)].w);
    };
    const double fx = std::floor(x);
    const double fy = std::floor(y);
    const double s = x - fx;
    const double t = y - fy;
    return (1 - t) * ((1 - s) * texel(fx, fy) + s * texel(fx + 1, fy))
           + t * ((1 - s) * texel(fx, fy + 1) + s * texel(fx + 1, fy + 1));
}

/// The definition: each texel of the map and its copies around it, the ray from the top of this
/// column to the surface there, and where it comes out for a quarter of a texel or more.
double ratio_by_definition(const BakedMap& map, bool repeats, int x, int y) {
    const double u = (x + 0.5) / map.width;
    const double v = (y + 0.5) / map.height;
    const double apex = map.texels[map.at(x, y)].w;
    double best = 1;
    const int reach = repeats ? 1 : 0;
    for (int j = -reach * map.height; j < (1 + reach) * map.height; ++j) {
        for (int i = -reach * map.width; i < (1 + reach) * map.width; ++i) {
            if (i == x && j == y) {
                continue;
            }
            const double du = (i + 0.5) / map.width - u;
            const double dv = (j + 0.5) / map.height - v;
            const double entry = depth_at(map, repeats, u + du, v + dv);
            const double step =
                0.25 / std::max(std::abs(du) * map.width, std::abs(dv) * map.height);
            const auto is_out = [&](double s) {
                return depth_at(map, repeats, u + s * du, v + s * dv) > entry * s;
            };
            double s = 1;
            while (entry * s < apex && s * std::hypot(du, dv) < 1 && !is_out(s + step)) {
                s += step;
            }
            for (const double end = s + step; s < end && !is_out(s + step / 64); s += step / 64) {
            }
            if (entry * s < apex) {
                best = std::min(best, s * std::hypot(du, dv) / (apex - entry * s));
            }
        }
    }
    return best;
}

/// Depth of the first hit of the ray from (u, v) at the top that goes (du, dv) over the full depth.
double first_hit(const BakedMap& map, double u, double v, double du, double dv) {
    constexpr int kSteps = 2000;
    for (int i = 0; i <= kSteps; ++i) {
        const double t = static_cast<double>(i) / kSteps;
        if (depth_at(map, true, u + t * du, v + t * dv) <= t) {
            return t;
        }
    }
    return 1;
}

/// Relaxed cone stepping and a binary search, as a shader does.
double march_by_cones(const BakedMap& cones, double u, double v, double du, double dv, int steps) {
    const double run = std::hypot(du, dv);
    double t = 0;
    double before = 0;
    for (int i = 0; i < steps; ++i) {
        const double x = u + t * du;
        const double y = v + t * dv;
        const auto cell = [](double at, int size) {
            return std::clamp(static_cast<int>((at - std::floor(at)) * size), 0, size - 1);
        };
        const float ratio = cones.texels[cones.at(cell(x, cones.width), cell(y, cones.height))].z;
        const double height = depth_at(cones, true, x, y) - t;
        if (height <= 0) {
            break;
        }
        before = t;
        t = std::min(t + height * ratio / (run + ratio), 1.0);
    }
    double low = before;
    double high = t;
    for (int i = 0; i < 20; ++i) {
        const double middle = 0.5 * (low + high);
        (depth_at(cones, true, u + middle * du, v + middle * dv) <= middle ? high : low) = middle;
    }
    return high;
}

}  // namespace

TEST_CASE("cone map: ratios are those of the definition") {
    for (const bool repeats : {true, false}) {
        for (const auto& depths :
             {make_depths(12, 12, pyramid), make_depths(16, 8, bumps),
              make_depths(13, 13, posts)}) {
            const BakedMap cones = make_cone_map(depths, repeats);
            double mean = 0;
            for (int y = 0; y < depths.height; y += 3) {
                for (int x = 0; x < depths.width; x += 3) {
                    const double expected = ratio_by_definition(depths, repeats, x, y);
                    const float found = cones.texels[cones.at(x, y)].z;
                    mean += expected;
                    // The product goes in steps of a quarter of a texel, the definition in finer
                    // ones.
                    CHECK(found <= expected + 0.01);
                    CHECK(found >= expected - 0.01);
                }
            }
            CHECK(mean > 0);
        }
    }
}

TEST_CASE("cone map: flat reliefs have the widest cones") {
    for (const float depth : {0.0f, 0.3f, 1.0f}) {
        const BakedMap cones =
            make_cone_map(make_depths(16, 16, [depth](float, float) { return depth; }), true);
        for (const Vec4& texel : cones.texels) {
            CHECK(texel.z == 1);
            CHECK(texel.w == depth);
        }
    }
}

TEST_CASE("cone map: a march by cones finds the first hit of a fine linear search") {
    // Depths at which both agree, of rays in all directions.
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(0, 1);
    for (const auto& depths :
         {make_depths(64, 64, pyramid), make_depths(64, 64, bumps), make_depths(64, 64, posts)}) {
        const BakedMap cones = make_cone_map(depths, true);
        int right = 0;
        constexpr int kRays = 150;
        for (int i = 0; i < kRays; ++i) {
            const double u = place(random);
            const double v = place(random);
            const double angle = 2 * kPi * place(random);
            const double run = 0.8 * place(random);
            const double du = run * std::cos(angle);
            const double dv = run * std::sin(angle);
            const double expected = first_hit(depths, u, v, du, dv);
            const double found = march_by_cones(cones, u, v, du, dv, 200);
            right += std::abs(found - expected) < 0.02 ? 1 : 0;
        }
        CHECK(right >= kRays * 97 / 100);
    }
}

TEST_CASE("cone map: a shift of a map that repeats shifts its cones") {
    const BakedMap depths = make_depths(24, 16, bumps);
    BakedMap shifted = depths;
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 24; ++x) {
            shifted.texels[shifted.at(x, y)] = depths.texels[depths.at((x + 7) % 24, (y + 5) % 16)];
        }
    }
    const BakedMap a = make_cone_map(depths, true);
    const BakedMap b = make_cone_map(shifted, true);
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 24; ++x) {
            CHECK(
                std::abs(b.texels[b.at(x, y)].z - a.texels[a.at((x + 7) % 24, (y + 5) % 16)].z)
                < 2e-3f);
        }
    }
}

TEST_CASE("cone map: the number of threads changes nothing, and NaN is deepest") {
    BakedMap depths = make_depths(32, 48, bumps);
    const int before = thread_count();
    set_thread_count(1);
    const BakedMap one = make_cone_map(depths, true);
    set_thread_count(4);
    CHECK(make_cone_map(depths, true).texels == one.texels);
    set_thread_count(before);
    depths.texels[5].w = NAN;
    for (const Vec4& texel : make_cone_map(depths, true).texels) {
        CHECK((texel.z > 0 && texel.z <= 1));
    }
}

}  // namespace limn::cone_map_test
