#pragma once

#include "ecs/base/hash.h"
#include "ecs/base/math.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace limn {

// Stateless random numbers: Philox4x32-10 (Salmon et al., "Parallel Random Numbers: As Easy as
// 1, 2, 3", SC 2011) turns a counter and a key into four words. Counter and key are made from seed,
// entity, system and frame, so that the numbers depend on neither the execution order nor the
// number of threads:
//
//     Random random(seed->seed, entity.bits(), name_hash("update_spray"), time->frame);
//     const float speed = random.uniform(1.0f, 2.0f);

using PhiloxCounter = std::array<std::uint32_t, 4>;
using PhiloxKey = std::array<std::uint32_t, 2>;

/// Four random words for one counter and key: a bijection of the counter for each key.
[[nodiscard]] constexpr PhiloxCounter philox4x32(PhiloxCounter counter, PhiloxKey key) {
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t a = std::uint64_t{0xd2511f53u} * counter[0];
        const std::uint64_t b = std::uint64_t{0xcd9e8d57u} * counter[2];
        counter = {
            static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key[0],
            static_cast<std::uint32_t>(b),
            static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key[1],
            static_cast<std::uint32_t>(a)};
        key[0] += 0x9e3779b9u;
        key[1] += 0xbb67ae85u;
    }
    return counter;
}

/// A sequence of up to 2^34 numbers. Sequences that differ in seed, subject, system or frame are
/// disjoint.
class Random {
  public:
    /// `subject`: what the numbers are for, usually Entity::bits(). `system`: name_hash of the
    /// system that draws them.
    constexpr Random(
        std::uint64_t seed, std::uint64_t subject, std::uint32_t system, std::uint64_t frame)
        : counter_{
            0, static_cast<std::uint32_t>(frame), static_cast<std::uint32_t>(subject),
            static_cast<std::uint32_t>(subject >> 32)} {
        const std::uint64_t key = hash_combine(hash_combine(seed, system), frame >> 32);
        key_ = {static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)};
    }
    /// With this counter words 1 .. 4 are drawn, for shaders that draw the same; it counts up.
    [[nodiscard]] constexpr PhiloxCounter counter() const { return counter_; }
    [[nodiscard]] constexpr PhiloxKey key() const { return key_; }

    /// 32 uniformly distributed bits.
    constexpr std::uint32_t word() {
        if (left_ == 0) {
            words_ = philox4x32(counter_, key_);
            ++counter_[0];
            left_ = 4;
        }
        return words_[4 - left_--];
    }

    /// 0 <= x < 1, a multiple of 2^-24.
    constexpr float uniform() { return static_cast<float>(word() >> 8) * 0x1p-24f; }

    /// low <= x < high, up to rounding.
    constexpr float uniform(float low, float high) { return low + (high - low) * uniform(); }

    /// 0 .. count - 1, count > 0. Bias below count / 2^32 (Lemire 2019, without rejection).
    constexpr std::uint32_t below(std::uint32_t count) {
        return static_cast<std::uint32_t>((std::uint64_t{word()} * count) >> 32);
    }

    /// Mean 0, standard deviation 1 (Box and Muller 1958). Takes two words.
    float normal() {
        const float u = static_cast<float>((word() >> 8) + 1) * 0x1p-24f;  // 0 < u <= 1
        const float angle = 2.0f * kPi * uniform();
        return std::sqrt(-2.0f * std::log(u)) * std::cos(angle);
    }

    /// A point on the unit sphere, uniform by area (Archimedes). Takes two words.
    Vec3 direction() {
        const float y = uniform(-1.0f, 1.0f);
        const float angle = 2.0f * kPi * uniform();
        const float radius = std::sqrt(std::max(1.0f - y * y, 0.0f));
        return {radius * std::cos(angle), y, radius * std::sin(angle)};
    }

    /// A point in the unit disc, uniform by area. Takes two words.
    Vec2 in_disc() {
        const float radius = std::sqrt(uniform());
        const float angle = 2.0f * kPi * uniform();
        return {radius * std::cos(angle), radius * std::sin(angle)};
    }

  private:
    PhiloxCounter counter_;
    PhiloxKey key_ = {};
    PhiloxCounter words_ = {};
    int left_ = 0;
};

}  // namespace limn
