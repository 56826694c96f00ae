#include "systems/particles/particle_sources.h"

#include "systems/particles/particle_births.h"

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

/// Collects births up to a limit and counts those beyond.
class Spawns {
  public:
    Spawns(
        const ParticlePool& parent, float inherit, std::size_t room,
        std::vector<ParticleSpawn>& out)
        : parent_(parent), inherit_(finite_or(inherit, 0)), room_(room), out_(out) {}

    /// `since`: time from the birth to the end of the step.
    void add_at(std::size_t i, float since, double count) {
        const Vec3 velocity = {parent_.vx[i], parent_.vy[i], parent_.vz[i]};
        const Vec3 now = {parent_.x[i], parent_.y[i], parent_.z[i]};
        add({now - velocity * since, velocity * inherit_, Vec3(0), since}, count);
    }
    void add_hit(const ParticleHit& hit, double count) {
        add({hit.point, hit.velocity * inherit_, hit.normal, 0}, count);
    }
    [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

  private:
    void add(const ParticleSpawn& spawn, double count) {
        const double free = static_cast<double>(room_ - out_.size());
        for (double i = 0; i < std::min(count, free); ++i) {
            out_.push_back(spawn);
        }
        constexpr double kMaxDropped = 1e12;  // infinity included
        dropped_ +=
            count > free ? static_cast<std::uint64_t>(std::min(count - free, kMaxDropped)) : 0;
    }

    const ParticlePool& parent_;
    float inherit_;
    std::size_t room_;
    std::vector<ParticleSpawn>& out_;
    std::uint64_t dropped_ = 0;
};

/// Births at equal intervals of a particle's age, offset by a random fraction of an interval: until
/// age t there are floor(rate t + fraction).
void add_trail(
    Spawns& spawns, const ParticleEmitter& emitter, const ParticlePool& parent, std::size_t i,
    float dt) {
    const float age = std::min(parent.age[i], parent.life[i]);
    const float began = std::max(parent.age[i] - dt, 0.0f);
    const float factor = sample_curve(emitter.rate_curve, age / std::max(parent.life[i], 1e-6f));
    const double rate = static_cast<double>(finite_or(emitter.rate, 0) * finite_or(factor, 0));
    if (!(rate > 0) || age <= began) {
        return;
    }
    const double fraction = (parent.look[i] >> 8) * 0x1p-24;
    const double first = std::floor(rate * static_cast<double>(began) + fraction) + 1;
    const double last = std::floor(rate * static_cast<double>(age) + fraction);
    for (double k = first; k <= std::min(last, first + 4096); ++k) {
        spawns.add_at(i, parent.age[i] - static_cast<float>((k - fraction) / rate), 1);
    }
}

}  // namespace

std::uint64_t find_spawns(
    const ParticleSource& source, const ParticleEmitter& emitter, const ParticlePool& parent,
    std::span<const ParticleHit> hits, float dt, std::size_t room, Random& random,
    std::vector<ParticleSpawn>& spawns) {
    Spawns found(parent, source.inherit, spawns.size() + room, spawns);
    const auto count = [&] {
        const float wanted =
            finite_or(source.count, 0) + finite_or(source.spread, 0) * random.uniform(-1.0f, 1.0f);
        return std::round(static_cast<double>(wanted));
    };
    switch (source.at) {
    case ParticleMoment::Birth:
        for (std::size_t i = parent.size() - std::min<std::size_t>(parent.fresh, parent.size());
             i < parent.size(); ++i) {
            found.add_at(i, parent.age[i], count());
        }
        break;
    case ParticleMoment::Flight:
        for (std::size_t i = 0; i < parent.size(); ++i) {
            add_trail(found, emitter, parent, i, dt);
        }
        break;
    case ParticleMoment::Hit:
        for (const ParticleHit& hit : hits) {
            found.add_hit(hit, count());
        }
        break;
    case ParticleMoment::Death:
        for (std::size_t i = 0; i < parent.size(); ++i) {
            if (parent.age[i] >= parent.life[i]) {
                found.add_at(i, std::min(parent.age[i] - parent.life[i], dt), count());
            }
        }
        break;
    }
    return found.dropped();
}

}  // namespace limn
