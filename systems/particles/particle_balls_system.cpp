#include "systems/particles/particle_balls_system.h"

#include "ecs/base/math.h"
#include "ecs/base/rng.h"
#include "systems/particles/particle_motion.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

// Techniques: particle.interparticle

namespace limn {
namespace {

constexpr std::uint32_t kMaxNear = 64;  // neighbors tested per ball: bounds the cost of a crowd
constexpr float kPairRadius = 1.1f;     // of the radius: pairs that pushes may bring into contact
constexpr int kPasses = 12;             // over all pairs: how many balls far a push spreads
constexpr float kBallRestSpeed = 0.2f;  // below this approach speed there is no rebound [m/s]
constexpr int kCellBits = 21;           // of each axis in a key
constexpr std::int64_t kLastCell = (std::int64_t{1} << kCellBits) - 2;

struct Keyed {
    std::uint64_t key;
    std::uint32_t index;
};

Vec3 ball_center(const ParticlePool& pool, std::size_t i) {
    return {pool.x[i], pool.y[i], pool.z[i]};
}

constexpr std::uint64_t key_of(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
    return x << (2 * kCellBits) | y << kCellBits | z;
}

/// 1 .. kLastCell, so that neighbors do not carry into another axis.
std::uint64_t ball_cell(float at, float lowest, float width) {
    const double cells = (static_cast<double>(at) - static_cast<double>(lowest)) / width;
    return static_cast<std::uint64_t>(
        std::clamp(cells, 0.0, static_cast<double>(kLastCell - 1)) + 1);
}

/// By cell, then by index.
std::vector<Keyed> sort_by_cell(const ParticlePool& pool, float width) {
    const auto lowest = [](const std::vector<float>& column) {
        return column.empty() ? 0.0f : *std::min_element(column.begin(), column.end());
    };
    const Vec3 low = {lowest(pool.x), lowest(pool.y), lowest(pool.z)};
    std::vector<Keyed> sorted(pool.size());
    for (std::uint32_t i = 0; i < sorted.size(); ++i) {
        sorted[i] = {
            key_of(
                ball_cell(pool.x[i], low.x, width), ball_cell(pool.y[i], low.y, width),
                ball_cell(pool.z[i], low.z, width)),
            i};
    }
    std::sort(sorted.begin(), sorted.end(), [](const Keyed& a, const Keyed& b) {
        return a.key != b.key ? a.key < b.key : a.index < b.index;
    });
    return sorted;
}

Vec3 velocity_of(const ParticlePool& pool, std::size_t i) {
    return {pool.vx[i], pool.vy[i], pool.vz[i]};
}

void accelerate(ParticlePool& pool, std::size_t i, const Vec3& change) {
    pool.vx[i] += change.x;
    pool.vy[i] += change.y;
    pool.vz[i] += change.z;
}

/// How the displacement of a pair is distributed: half each, or all of it to the one that does not
/// stick to a surface.
struct MassWeights {
    float a = 0.5f;
    float b = 0.5f;
};

MassWeights weights_of(const ParticlePool& pool, const BallPair& pair) {
    const auto is_free = [&](std::uint32_t i) {
        return i >= pool.stuck.size() || pool.stuck[i] == 0;
    };
    const float a = is_free(pair.a) ? 1.0f : 0.0f;
    const float b = is_free(pair.b) ? 1.0f : 0.0f;
    return a + b > 0 ? MassWeights{a / (a + b), b / (a + b)} : MassWeights{0, 0};
}

/// The positions of a pool, which passes move apart until almost no balls overlap.
class BallPositions {
  public:
    BallPositions(const ParticleBalls& balls, const BallWalls& walls, const ParticlePool& pool)
        : radius_(balls.radius), walls_(walls), pool_(pool), x_(pool.x), y_(pool.y), z_(pool.z) {}

    [[nodiscard]] Vec3 at(std::uint32_t i) const { return {x_[i], y_[i], z_[i]}; }

    /// Unit, from one to the other.
    [[nodiscard]] Vec3 axis_of(const BallPair& pair) const {
        const Vec3 between = at(pair.b) - at(pair.a);
        const float distance = glm::length(between);
        if (distance > 0) {
            return between / distance;
        }
        Random random(pool_.look[pair.a], pool_.look[pair.b], name_hash("particle balls"), 0);
        return random.direction();
    }
    /// Returns whether they overlapped.
    bool push_apart(const BallPair& pair) {
        const float overlap = 2 * radius_ - glm::distance(at(pair.a), at(pair.b));
        if (overlap > 0) {
            const Vec3 axis = axis_of(pair);
            const MassWeights weights = weights_of(pool_, pair);
            move(pair.a, (-overlap * weights.a) * axis);
            move(pair.b, (overlap * weights.b) * axis);
        }
        return overlap > 0;
    }
    /// Stops balls at the walls that they have been pushed into since the last call.
    void collide_with_walls() {
        if (walls_.solid == nullptr || walls_.solid->colliders.empty()) {
            return;
        }
        if (held_x_.empty()) {
            held_x_ = pool_.x;
            held_y_ = pool_.y;
            held_z_ = pool_.z;
        }
        for (auto* const column : {&vx_, &vy_, &vz_}) {
            column->assign(pool_.size(), 0.0f);
        }
        marks_.assign(pool_.size(), 0);
        hits_.clear();
        collide_particles(
            {.x0 = held_x_,
             .y0 = held_y_,
             .z0 = held_z_,
             .x = x_,
             .y = y_,
             .z = z_,
             .vx = vx_,
             .vy = vy_,
             .vz = vz_,
             .marks = marks_},
            0, *walls_.solid, {.bounce = 0, .friction = 1}, {.radius = walls_.radius}, hits_);
        held_x_ = x_;
        held_y_ = y_;
        held_z_ = z_;
    }

  private:
    void move(std::uint32_t i, const Vec3& offset) {
        x_[i] += offset.x;
        y_[i] += offset.y;
        z_[i] += offset.z;
    }

    float radius_;
    BallWalls walls_;
    const ParticlePool& pool_;
    std::vector<float> x_, y_, z_;
    std::vector<float> held_x_, held_y_, held_z_;  // after the last call of collide_with_walls
    std::vector<float> vx_, vy_, vz_;
    std::vector<std::uint8_t> marks_;
    std::vector<ParticleHit> hits_;
};

}  // namespace

void find_ball_pairs(const ParticlePool& pool, float radius, std::vector<BallPair>& pairs) {
    pairs.clear();
    const float width = 2 * radius;
    const std::vector<Keyed> sorted = sort_by_cell(pool, width);
    const std::size_t count = sorted.size();
    // Half of the neighbor cells: the own cell and the next one in z, then rows of three along z.
    constexpr std::uint64_t kRows[] = {
        key_of(0, 1, 0), key_of(1, 0, 0) - key_of(0, 1, 0), key_of(1, 0, 0),
        key_of(1, 0, 0) + key_of(0, 1, 0)};
    std::array<std::size_t, std::size(kRows)> begins{};
    for (std::size_t i = 0; i < count; ++i) {
        const Keyed& one = sorted[i];
        const Vec3 center = ball_center(pool, one.index);
        std::uint32_t tested = 0;
        const auto test_from = [&](std::size_t first, std::uint64_t last_key) {
            for (std::size_t j = first; j < count && sorted[j].key <= last_key && tested < kMaxNear;
                 ++j) {
                ++tested;
                const Vec3 offset = ball_center(pool, sorted[j].index) - center;
                if (glm::dot(offset, offset) < width * width) {
                    pairs.push_back({one.index, sorted[j].index});
                }
            }
        };
        test_from(i + 1, one.key + 1);
        for (std::size_t row = 0; row < begins.size(); ++row) {
            const std::uint64_t center_key = one.key + kRows[row];
            std::size_t& begin = begins[row];
            while (begin < count && sorted[begin].key < center_key - 1) {
                ++begin;
            }
            test_from(begin, center_key + 1);
        }
    }
}

void collide_balls(
    const ParticleBalls& balls, const BallWalls& walls, float dt, ParticlePool& pool) {
    if (!(balls.radius > 0) || !std::isfinite(balls.radius) || !(dt > 0)) {
        return;
    }
    std::vector<BallPair> pairs;
    find_ball_pairs(pool, kPairRadius * balls.radius, pairs);
    if (pairs.empty()) {
        return;
    }
    BallPositions positions(balls, walls, pool);
    std::vector<std::uint8_t> touched(pairs.size(), 0);
    for (int pass = 0; pass < kPasses; ++pass) {
        for (std::size_t k = 0; k < pairs.size(); ++k) {
            // Alternating order, so that no pair is favored.
            const std::size_t i = pass % 2 == 0 ? k : pairs.size() - 1 - k;
            if (positions.push_apart(pairs[i])) {
                touched[i] = 1;
            }
        }
        positions.collide_with_walls();
    }
    std::vector<float> approach;  // speeds before the collision
    approach.reserve(pairs.size());
    for (const BallPair& pair : pairs) {
        approach.push_back(glm::dot(
            velocity_of(pool, pair.a) - velocity_of(pool, pair.b), positions.axis_of(pair)));
    }
    for (std::uint32_t i = 0; i < pool.size(); ++i) {
        const Vec3 push = positions.at(i) - ball_center(pool, i);
        accelerate(pool, i, push / dt);
        pool.x[i] += push.x;
        pool.y[i] += push.y;
        pool.z[i] += push.z;
    }
    // The separation speed follows from the bounce alone, not from the distance pushed.
    const float bounce = std::clamp(finite_or(balls.bounce, 0), 0.0f, 1.0f);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (touched[i] == 0) {
            continue;
        }
        const BallPair& pair = pairs[i];
        const Vec3 axis = positions.axis_of(pair);
        const float parting = glm::dot(velocity_of(pool, pair.b) - velocity_of(pool, pair.a), axis);
        const float wanted =
            approach[i] > kBallRestSpeed ? bounce * approach[i] : std::max(-approach[i], 0.0f);
        const MassWeights weights = weights_of(pool, pair);
        accelerate(pool, pair.a, ((parting - wanted) * weights.a) * axis);
        accelerate(pool, pair.b, ((wanted - parting) * weights.b) * axis);
    }
}

void update_particle_balls(
    Query<const ParticleBalls, Optional<const ParticleCollision>, ParticlePool> emitters,
    Res<const ParticleObstacles> obstacles, Res<const FrameTime> time) {
    const float dt = std::min(time->step, kMaxParticleStep);
    emitters.each(
        [&](const ParticleBalls& balls, const ParticleCollision* collision, ParticlePool& pool) {
            BallWalls walls;
            if (collision != nullptr) {
                walls = {&obstacles->solid, std::max(finite_or(collision->radius, 0), 0.0f)};
            }
            collide_balls(balls, walls, dt, pool);
        });
}

}  // namespace limn
