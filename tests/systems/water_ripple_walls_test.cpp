#include "ecs/base/jobs.h"
#include "ecs/components/all.h"
#include "ecs/components/transform.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"
#include "systems/update_world.h"
#include "systems/water/water_ripple_field.h"
#include "systems/water/water_ripple_grid.h"
#include "systems/water/water_ripple_walls.h"
#include "tests/near.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace limn::water_ripple_walls_test {

namespace {

constexpr float kStep = 1.0f / 60;
constexpr WaterRipples kUndamped = {.cell = 0.05f, .speed = 1.5f, .damping = 0};

Affine at(const Vec3& position, float turn = 0) {
    return affine_from(position, glm::angleAxis(turn, Vec3(0, 1, 0)), Vec3(1));
}

PlacedWall box(const RippleState& state, const Vec3& half, const Affine& index_of) {
    const auto wall = place_wall({.half = half}, index_of, {}, 0, state.size());
    REQUIRE(wall.has_value());
    return *wall;
}

PlacedWall column(const RippleState& state, float radius, const Vec2& index_of) {
    const auto wall = place_wall(
        {.shape = WallShape::Cylinder, .half = {radius, 2, radius}},
        at({index_of.x, 0, index_of.y}), {}, 0, state.size());
    REQUIRE(wall.has_value());
    return *wall;
}

RippleState make_walled(
    const Vec2& size, const WaterRipples& ripples,
    const std::function<std::vector<PlacedWall>(const RippleState&)>& walls) {
    RippleState state = make_ripples({.size = size, .depth = 2}, ripples, kStep);
    set_ripple_walls(state, walls(state), ripples.border);
    return state;
}

void run(RippleState& state, const WaterRipples& ripples, int steps) {
    for (int i = 0; i < steps; ++i) {
        step_ripples(state, ripples, kStep);
    }
}

Vec2 cell_position(const RippleState& state, int x, int z) {
    return state.cell * (Vec2(x, z) + 0.5f - 0.5f * Vec2(state.cells));
}

/// Largest height, up or down, of the water where `where` holds.
float max_height(const RippleState& state, const std::function<bool(const Vec2&)>& where) {
    float most = 0;
    for (int z = 0; z < state.cells.y; ++z) {
        for (int x = 0; x < state.cells.x; ++x) {
            if (where(cell_position(state, x, z))
                && (state.dry.empty() || !state.dry[state.at(x, z)])) {
                const float height = std::abs(state.height[state.at(x, z)]);
                if (std::isnan(height)) {
                    return height;
                }
                most = std::max(most, height);
            }
        }
    }
    return most;
}

/// A crest along z at `x`, that runs along +x.
void start_pulse(RippleState& state, float x, float speed) {
    for (int z = 0; z < state.cells.y; ++z) {
        for (int i = 0; i < state.cells.x; ++i) {
            const float from = cell_position(state, i, z).x - x;
            const float ago = from + speed * state.substep;
            state.height[state.at(i, z)] = 0.1f * std::exp(-square(from / 0.25f));
            state.previous[state.at(i, z)] = 0.1f * std::exp(-square(ago / 0.25f));
        }
    }
    state.level = ripple_volume(state)
                  / (static_cast<double>(state.cell * state.cell) * static_cast<double>(state.wet));
}

/// The wave equation between walls in double precision, from the exchanges of each square of four
/// cells; borders reflect.
class Reference {
  public:
    explicit Reference(const RippleState& state, const WaterRipples& ripples) : size_(state.cells) {
        const float courant = ripples.speed * state.substep / state.cell;
        factor_ = static_cast<double>(courant) * courant / 6;
        for (int z = -1; z <= size_.y; ++z) {
            for (int x = -1; x <= size_.x; ++x) {
                const std::size_t index_of = state.at(x, z);
                const bool on = x >= 0 && z >= 0 && x < size_.x && z < size_.y;
                wet_.push_back(on && (state.dry.empty() || state.dry[index_of] == 0));
                now_.push_back(wet_.back() ? state.height[index_of] : 0);
                before_.push_back(wet_.back() ? state.previous[index_of] : 0);
            }
        }
    }

    void step() {
        std::vector<double> next = now_;
        each_exchange([&](std::size_t a, std::size_t b, double weight) {
            next[a] += factor_ * weight * (now_[b] - now_[a]);
            next[b] += factor_ * weight * (now_[a] - now_[b]);
        });
        for (std::size_t i = 0; i < next.size(); ++i) {
            next[i] += now_[i] - before_[i];
        }
        before_ = now_;
        now_ = next;
    }

    /// What leapfrog keeps.
    [[nodiscard]] double energy() const {
        double sum = 0;
        for (std::size_t i = 0; i < now_.size(); ++i) {
            sum += (now_[i] - before_[i]) * (now_[i] - before_[i]);
        }
        each_exchange([&](std::size_t a, std::size_t b, double weight) {
            sum += factor_ * weight * (now_[a] - now_[b]) * (before_[a] - before_[b]);
        });
        return sum;
    }

    [[nodiscard]] double height(int x, int z) const { return now_[index_of(x, z)]; }

  private:
    [[nodiscard]] std::size_t index_of(int x, int z) const {
        return static_cast<std::size_t>((z + 1) * (size_.x + 2) + x + 1);
    }

    template <typename Body>
    void each_exchange(Body&& body) const {
        for (int z = -1; z < size_.y; ++z) {
            for (int x = -1; x < size_.x; ++x) {
                const std::size_t a = index_of(x, z);
                const std::size_t b = index_of(x + 1, z);
                const std::size_t c = index_of(x, z + 1);
                const std::size_t d = index_of(x + 1, z + 1);
                const auto edge = [&](std::size_t p, std::size_t q, double weight) {
                    if (wet_[p] && wet_[q]) {
                        body(p, q, weight);
                    }
                };
                edge(a, b, 4);
                edge(a, c, 4);
                const int count = wet_[a] + wet_[b] + wet_[c] + wet_[d];
                if (count > 2) {
                    edge(a, d, 1);
                    edge(b, c, 1);
                } else if (count == 2) {
                    edge(a, b, 1);
                    edge(a, c, 1);
                    edge(b, d, 1);
                    edge(c, d, 1);
                }
            }
        }
    }

    IVec2 size_;
    double factor_ = 0;
    std::vector<char> wet_;
    std::vector<double> now_;
    std::vector<double> before_;
};

/// A pool with columns, a wall across a corner, and one that touches the border.
std::vector<PlacedWall> maze(const RippleState& state) {
    return {
        column(state, 0.3f, {0.6f, 0.2f}), column(state, 0.12f, {-0.9f, -0.7f}),
        box(state, {0.5f, 1, 0.02f}, at({-1.2f, 0, 0.9f}, 0.6f)),
        box(state, {0.4f, 1, 0.15f}, at({0.2f, 0, -1.4f}))};
}

}  // namespace

TEST_CASE("ripple walls: a wall acts like the border of the pool, and nothing passes through") {
    // 6 m with a wall over the last 2, against 4 m alone.
    RippleState walled = make_walled({6, 0.5f}, kUndamped, [](const RippleState& state) {
        return std::vector<PlacedWall>{box(state, {1, 1, 1}, at({2, 0, 0}))};
    });
    RippleState alone = make_ripples({.size = {4, 0.5f}}, kUndamped, kStep);
    start_pulse(walled, -1, kUndamped.speed);
    start_pulse(alone, 0, kUndamped.speed);
    for (const int steps : {60, 60, 240}) {
        run(walled, kUndamped, steps);
        run(alone, kUndamped, steps);
        for (int z = 0; z < alone.cells.y; ++z) {
            for (int x = 0; x < alone.cells.x; ++x) {
                const float difference =
                    walled.height[walled.at(x, z)] - alone.height[alone.at(x, z)];
                CHECK(std::abs(difference) < 2e-6f);
            }
        }
        CHECK(max_height(walled, [](const Vec2& p) { return p.x > 1; }) == 0);
    }
}

TEST_CASE("ripple walls: a crest is reflected as a crest of equal height, at the wall's position") {
    RippleState state = make_walled({8, 0.4f}, kUndamped, [](const RippleState& made) {
        return std::vector<PlacedWall>{box(made, {0.2f, 1, 1}, at({2, 0, 0}))};
    });
    start_pulse(state, 0, kUndamped.speed);
    run(state, kUndamped, 120);  // 3 m: 1.8 there, 1.2 back
    CHECK(sample_ripples(state, {0.6f, 0}).height == test::near(0.1).epsilon(0.06).scale(0));
    CHECK(max_height(state, [](const Vec2& p) { return p.x > 2.2f; }) < 1e-6f);
    // Halfway, the wall is as high again as the crest.
    start_pulse(state, 0, kUndamped.speed);
    run(state, kUndamped, 72);
    CHECK(sample_ripples(state, {1.78f, 0}).height == test::near(0.2).epsilon(0.06).scale(0));
}

TEST_CASE("ripple walls: the thinnest wall is tight at any rotation") {
    for (const float turn : {0.0f, 0.3f, 0.785398f, 1.1f, 1.57f}) {
        const WaterRipples ripples = {.cell = 0.05f, .speed = 2, .damping = 0};
        const Vec2 normal = {std::sin(turn), std::cos(turn)};
        RippleState state = make_walled({3, 3}, ripples, [&](const RippleState& made) {
            return std::vector<PlacedWall>{box(made, {4, 1, 0.001f}, at({0.013f, 0, 0.02f}, turn))};
        });
        push_ripples(state, {.center = 0.9f * normal, .radius = 0.5f, .height = 0.2f});
        run(state, ripples, 300);
        const auto side = [&](float sign) {
            return [=](const Vec2& p) { return sign * glm::dot(p, normal) > 0.1f; };
        };
        CHECK(max_height(state, side(1)) > 0.003f);
        CHECK(max_height(state, side(-1)) < 1e-6f);
    }
}

TEST_CASE("ripple walls: cells that touch only at their corners form a wall") {
    RippleState state = make_walled({3, 3}, kUndamped, [](const RippleState& made) {
        std::vector<PlacedWall> stairs;
        for (int i = 0; i < made.cells.x; ++i) {
            const Vec2 index_of = cell_position(made, i, i);
            stairs.push_back(column(made, 0.02f, index_of));
        }
        return stairs;
    });
    REQUIRE(state.wet == state.cells.x * state.cells.y - state.cells.x);
    push_ripples(state, {.center = {0.8f, -0.8f}, .radius = 0.5f, .height = 0.2f});
    run(state, kUndamped, 300);
    CHECK(max_height(state, [](const Vec2& p) { return p.x > p.y; }) > 0.01f);
    CHECK(max_height(state, [](const Vec2& p) { return p.x < p.y; }) < 1e-6f);
}

TEST_CASE("ripple walls: inside them nothing moves") {
    RippleState state = make_walled({4, 3}, kUndamped, [](const RippleState& made) {
        return std::vector<PlacedWall>{box(made, {0.8f, 1, 0.8f}, at({0, 0, 0}))};
    });
    push_ripples(state, {.center = {-1.4f, 0}, .radius = 0.5f, .height = 0.2f});
    for (int i = 0; i < 200; ++i) {
        run(state, kUndamped, 1);
        float most = 0;
        for (int z = 0; z < state.cells.y; ++z) {
            for (int x = 0; x < state.cells.x; ++x) {
                const Vec2 p = glm::abs(cell_position(state, x, z));
                if (std::max(p.x, p.y) < 0.65f) {
                    most = std::max(most, std::abs(state.height[state.at(x, z)]));
                }
            }
        }
        CHECK(most == 0);
    }
}

TEST_CASE("ripple walls: exchanges match the sum over squares of four cells, in double precision") {
    RippleState state = make_walled({4, 3}, kUndamped, maze);
    REQUIRE(state.wet < state.cells.x * state.cells.y);
    push_ripples(state, {.center = {-0.2f, 0.3f}, .radius = 0.5f, .height = 0.2f});
    Reference reference(state, kUndamped);
    const int steps = 300;
    run(state, kUndamped, steps);
    for (int i = 0; i < steps * state.substeps; ++i) {
        reference.step();
    }
    for (int z = 0; z < state.cells.y; ++z) {
        for (int x = 0; x < state.cells.x; ++x) {
            if (state.dry[state.at(x, z)] == 0) {
                const double height = state.height[state.at(x, z)];
                CHECK(std::abs(height - reference.height(x, z)) < 2e-5);
            }
        }
    }
}

TEST_CASE("ripple walls: between them waves neither grow nor decay") {
    RippleState state = make_walled({4, 3}, kUndamped, maze);
    push_ripples(state, {.center = {-0.2f, 0.3f}, .radius = 0.5f, .height = 0.2f});
    const double energy = Reference(state, kUndamped).energy();
    for (int i = 0; i < 30; ++i) {
        run(state, kUndamped, 40);
        CHECK(Reference(state, kUndamped).energy() == test::near(energy).epsilon(1e-3).scale(0));
    }
}

TEST_CASE("ripple walls: a step conserves volume to a millionth of what moves") {
    RippleState state = make_walled({4, 3}, {}, maze);
    push_ripples(state, {.center = {-0.2f, 0.3f}, .radius = 0.5f, .height = 0.2f});
    double moved = 0;
    for (std::size_t i = 0; i < state.height.size(); ++i) {
        moved += state.dry[i] != 0 ? 0.0 : std::abs(static_cast<double>(state.height[i]));
    }
    moved *= static_cast<double>(state.cell * state.cell);
    for (int i = 0; i < 600; ++i) {
        const double before = ripple_volume(state);
        run(state, {}, 1);
        CHECK(std::abs(ripple_volume(state) - before) < 1e-6 * moved);
    }
    CHECK(std::abs(ripple_volume(state)) < 1e-5 * moved);
}

TEST_CASE("ripple walls: symmetry is preserved") {
    RippleState state = make_walled({4.05f, 4.05f}, kUndamped, [](const RippleState& made) {
        return std::vector<PlacedWall>{column(made, 0.4f, {0, 0}), column(made, 0.2f, {0, 1.2f})};
    });
    push_ripples(state, {.center = {0, -1}, .radius = 0.5f, .height = 0.2f});
    run(state, kUndamped, 240);
    for (int z = 0; z < state.cells.y; ++z) {
        for (int x = 0; x < state.cells.x / 2; ++x) {
            const float left = state.height[state.at(x, z)];
            const float right = state.height[state.at(state.cells.x - 1 - x, z)];
            CHECK(std::abs(left - right) < 1e-6f);
        }
    }
}

TEST_CASE("ripple walls: a ring diffracts around a column, and is lower behind it") {
    float behind[2] = {};
    float early[2] = {};
    for (const bool stands : {false, true}) {
        RippleState state = make_walled({8, 6}, kUndamped, [&](const RippleState& made) {
            return stands ? std::vector<PlacedWall>{column(made, 0.6f, {0, 0})}
                          : std::vector<PlacedWall>{};
        });
        push_ripples(state, {.center = {-1.5f, 0}, .radius = 0.5f, .height = 0.2f});
        for (int i = 0; i < 160; ++i) {
            run(state, kUndamped, 1);
            const float height = std::abs(sample_ripples(state, {1.0f, 0}).height);
            behind[stands] = std::max(behind[stands], height);
            // Straight ahead is 2.5 m less the radius; around the column 2.68 m.
            early[stands] = i < 82 ? behind[stands] : early[stands];
        }
    }
    CHECK(behind[1] > 0.2f * behind[0]);
    CHECK(behind[1] < 0.8f * behind[0]);
    CHECK(early[1] < 0.4f * early[0]);
}

TEST_CASE("ripple walls: their section with the rest surface counts, for any shape") {
    const auto dry_area = [](const WaterWall& wall, const Affine& index_of) {
        RippleState state = make_ripples({.size = {4, 4}}, {.cell = 0.02f}, kStep);
        const auto placed = place_wall(wall, index_of, {}, 0, state.size());
        if (placed) {
            set_ripple_walls(state, {&*placed, 1}, RippleBorder::Reflecting);
        }
        const int dry = state.cells.x * state.cells.y - state.wet;
        return static_cast<double>(state.cell * state.cell) * dry;
    };
    const WaterWall wide = {.half = {0.6f, 0.5f, 0.4f}};
    CHECK(dry_area(wide, at({0.3f, 0, -0.2f}, 0.5f)) == test::near(0.96).epsilon(0.03).scale(0));
    CHECK(dry_area(wide, at({1.9f, 0, 0})) == test::near(0.7 * 0.8).epsilon(0.03).scale(0));
    const WaterWall round = {.shape = WallShape::Cylinder, .half = {0.5f, 1, 0.3f}};
    CHECK(dry_area(round, at({0, 0.4f, 0})) == test::near(0.15 * 3.1416).epsilon(0.03).scale(0));
    const WaterWall ball = {.shape = WallShape::Ball, .half = Vec3(0.5f)};
    CHECK(dry_area(ball, at({0, 0.3f, 0})) == test::near(0.16 * 3.1416).epsilon(0.03).scale(0));
    // On its side a cylinder is a rectangle; tilted by 45 degrees a slab is wider.
    const Affine lies = affine_from(Vec3(0), glm::angleAxis(radians(90), Vec3(1, 0, 0)), Vec3(1));
    CHECK(dry_area(round, lies) == test::near(1.0 * 2).epsilon(0.03).scale(0));
    const Affine leans = affine_from(Vec3(0), glm::angleAxis(radians(45), Vec3(0, 0, 1)), Vec3(1));
    CHECK(
        dry_area({.half = {0.2f, 1, 0.5f}}, leans)
        == test::near(0.4 * 1.41421).epsilon(0.03).scale(0));
    // A step under water is none, and so is what hangs above it.
    CHECK(dry_area(wide, at({0, -0.51f, 0})) == 0);
    CHECK(dry_area(wide, at({0, 0.51f, 0})) == 0);
}

TEST_CASE("ripple walls: a new wall raises the water by its volume, a removed one lowers it") {
    RippleState state = make_ripples({.size = {4, 3}, .depth = 0.8f}, {.damping = 1}, kStep);
    push_ripples(state, {.center = {0.5f, 0.2f}, .radius = 0.5f, .height = 0.1f});
    run(state, {.damping = 1}, 5);
    const WaterWall wall = {.half = {0.3f, 5, 0.4f}};
    const double volume = 0.6 * 0.8 * 0.8;  // down to the bottom
    const auto placed = place_wall(wall, at({0.5f, 0, 0.2f}), {}, 0.8f, state.size());
    set_ripple_walls(state, {&*placed, 1}, RippleBorder::Reflecting);
    CHECK(ripple_volume(state) == test::near(volume).epsilon(1e-5).scale(0));
    run(state, {.damping = 1}, 1200);
    CHECK(ripple_volume(state) == test::near(volume).epsilon(1e-5).scale(0));
    const double level = volume / (12 - 0.48);
    CHECK(state.level == test::near(level).epsilon(0.01).scale(0));
    CHECK(sample_ripples(state, {-1.5f, -1}).height == test::near(level).epsilon(0.02).scale(0));
    set_ripple_walls(state, {}, RippleBorder::Reflecting);
    CHECK(std::abs(ripple_volume(state)) < 1e-5);
    CHECK(state.wet == state.cells.x * state.cells.y);
    CHECK(state.faces.empty());
    // It leaves a hole that fills from around.
    CHECK(sample_ripples(state, {0.5f, 0.2f}).height < -0.1f);
    run(state, {.damping = 1}, 1200);
    CHECK(std::abs(sample_ripples(state, {0.5f, 0.2f}).height) < 1e-3f);
}

TEST_CASE(
    "ripple walls: with any motion, the water level matches the volume of all that is in it") {
    RippleState state = make_ripples({.size = {4, 3}, .depth = 0.8f}, {}, kStep);
    run(state, {}, 1);
    const WaterWall wall = {.half = {0.3f, 5, 0.4f}};
    const double walled = 0.6 * 0.8 * 0.8;
    const WaterBulge body = {.center = {-1, 0}, .radius = {0.4f, 0.4f}, .volume = 0.2f};
    for (const float x : {0.5f, 0.6f, 0.9f}) {
        const auto placed = place_wall(wall, at({x, 0, 0.2f}), {}, 0.8f, state.size());
        // Two at the same position count twice.
        const PlacedWall walls[] = {*placed, *placed};
        const std::size_t standing = x == 0.6f ? 2 : 1;
        set_ripple_walls(state, {walls, standing}, RippleBorder::Reflecting);
        const double bodies = x == 0.5f ? 0 : 0.2;
        const double area = static_cast<double>(state.cell) * state.cell * state.wet;
        const double told = state.level * area;
        run(state, {}, 1);
        const double walls_now = static_cast<double>(standing) * walled;
        CHECK(told == test::near(walls_now + bodies).epsilon(1e-4).scale(0));
        displace_ripples(state, {&body, 1});
    }
}

TEST_CASE("ripple walls: a half submerged wall displaces half of its volume") {
    RippleState state = make_ripples({.size = {4, 3}}, {}, kStep);
    run(state, {}, 1);
    const PlacedWall wall = box(state, {0.4f, 0.5f, 0.3f}, at({2, 0, 0}));
    set_ripple_walls(state, {&wall, 1}, RippleBorder::Reflecting);
    CHECK(ripple_volume(state) == test::near(0.4 * 0.5 * 0.6).epsilon(1e-5).scale(0));
}

TEST_CASE("ripple walls: a wall that moves in level water leaves it level") {
    RippleState state = make_ripples({.size = {4, 3}}, {}, kStep);
    run(state, {}, 1);
    const auto stand = [&](float x) {
        const auto wall =
            place_wall({.half = {0.3f, 1, 0.3f}}, at({x, 0, 0}), {}, 1e-7f, state.size());
        set_ripple_walls(state, {&*wall, 1}, RippleBorder::Reflecting);
    };
    stand(0);
    for (int z = 0; z < state.cells.y; ++z) {
        for (int x = 0; x < state.cells.x; ++x) {
            const float level = is_dry(state, state.at(x, z)) ? 0 : 0.05f;
            state.height[state.at(x, z)] = level;
            state.previous[state.at(x, z)] = level;
        }
    }
    stand(0.1f);
    float worst = 0;
    for (int z = 0; z < state.cells.y; ++z) {
        for (int x = 0; x < state.cells.x; ++x) {
            const std::size_t index_of = state.at(x, z);
            const float off = std::max(
                std::abs(state.height[index_of] - 0.05f),
                std::abs(state.previous[index_of] - 0.05f));
            worst = is_dry(state, index_of) ? worst : std::max(worst, off);
        }
    }
    CHECK(worst < 1e-5f);
}

TEST_CASE("ripple walls: a moving wall makes waves and conserves volume, with bodies or without") {
    World world;
    Schedule schedule = make_world_schedule();
    const Entity pool = world.create(
        Transform{}, Water{.size = {4, 3}, .depth = 0.3f}, WaterRipples{.damping = 0.2f});
    const Entity pier = world.create(Transform{}, WaterWall{.half = {0.2f, 2, 0.3f}});
    const Entity stone =
        world.create(Transform{.position = {1, -0.25f, 0.5f}}, WaterTouch{.half = Vec3(0.2f)});
    world.create(Transform{.position = {-1, 0, 0.5f}}, WaterWall{.half = {0.2f, 2, 0.3f}});
    const double ball = 4.0 / 3.0 * 3.14159265 * 0.008;
    for (int i = 0; i < 240; ++i) {
        Transform& index_of = world.get<Transform>(pier);
        index_of.position.x = 0.6f * std::sin(0.02f * static_cast<float>(i));
        index_of.rotation = glm::angleAxis(0.01f * static_cast<float>(i), Vec3(0, 1, 0));
        step_world(world, schedule);
        CHECK(
            ripple_volume(world.get<RippleState>(pool)) == test::near(ball).epsilon(1e-4).scale(0));
    }
    const RippleState& state = world.get<RippleState>(pool);
    CHECK(max_height(state, [](const Vec2&) { return true; }) > 0.01f);
    CHECK(max_height(state, [](const Vec2&) { return true; }) < 0.5f);
    world.destroy(stone);
    world.destroy(pier);
    step_world(world, schedule);
    CHECK(ripple_volume(state) == test::near(-0.4 * 0.6 * 0.3).epsilon(1e-4).scale(0));
}

TEST_CASE("ripple walls: the corrections are rebuilt only when a wall has moved") {
    World world;
    Schedule schedule = make_world_schedule();
    const Entity pool = world.create(Transform{}, Water{.size = {4, 3}}, WaterRipples{.rain = 20});
    const Entity pier = world.create(Transform{}, WaterWall{});
    step_world(world, schedule);
    RippleState& state = world.get<RippleState>(pool);
    REQUIRE(!state.faces.empty());
    const float weight = state.faces[0].weight;
    state.faces[0].weight = weight + 1e-6f;
    for (int i = 0; i < 5; ++i) {
        step_world(world, schedule);
    }
    CHECK(state.faces[0].weight != weight);
    world.get<Transform>(pier).position.x = 0.1f;
    step_world(world, schedule);
    CHECK(state.faces[0].weight == weight);
}

TEST_CASE("ripple walls: results are the same for any number of threads") {
    std::vector<float> first;
    for (const int threads : {1, 2, 5}) {
        set_thread_count(threads);
        RippleState state = make_walled({9, 7}, kUndamped, maze);
        push_ripples(state, {.center = {-0.2f, 0.3f}, .radius = 0.5f, .height = 0.2f});
        run(state, kUndamped, 60);
        first = first.empty() ? state.height : first;
        CHECK(state.height == first);
    }
    set_thread_count(2);
}

TEST_CASE("ripple walls: a long wall with its center outside the field extends into it") {
    for (const bool turned : {false, true}) {
        World world;
        Schedule schedule = make_world_schedule();
        const Quat turn = glm::angleAxis(turned ? 1.570796f : 0.0f, Vec3(0, 1, 0));
        const Entity pool =
            world.create(Transform{.rotation = turn}, Water{.size = {4, 3}}, WaterRipples{});
        world.create(
            Transform{.position = {9, 0, 0}, .scale = {10, 1, 1}}, WaterWall{.half = {1, 1, 0.1f}});
        step_world(world, schedule);
        const RippleState& state = world.get<RippleState>(pool);
        const int dry = state.cells.x * state.cells.y - state.wet;
        // From -1 m to the edge at 2 m or 1.5 m, four or so cells thick.
        const int along = turned ? 50 : 60;
        CHECK(dry >= 3 * along);
        CHECK(dry <= 5 * along);
    }
}

TEST_CASE("ripple walls: a snapshot continues like the world") {
    register_all_components();
    Schedule schedule = make_world_schedule();
    World world;
    const Entity pool = world.create(Transform{}, Water{.size = {4, 3}}, WaterRipples{.rain = 40});
    world.create(Transform{.position = {0.5f, 0, 0}}, WaterWall{.half = {0.2f, 1, 0.3f}});
    world.create(Transform{.position = {-1, 0, 0}}, WaterTouch{});
    start_world(world);
    const auto run_world = [&](World& one, int steps) {
        for (int i = 0; i < steps; ++i) {
            step_world(one, schedule);
        }
    };
    run_world(world, 20);
    const Result<std::vector<std::byte>> saved = save_snapshot(world);
    REQUIRE(saved.ok());
    World again;
    REQUIRE(restore_snapshot(again, saved.value()).ok());
    run_world(world, 20);
    run_world(again, 20);
    CHECK(again.get<RippleState>(pool).height == world.get<RippleState>(pool).height);
    CHECK(!again.get<RippleState>(pool).faces.empty());
    // One that is broken begins anew.
    for (int part = 0; part < 5; ++part) {
        RippleState& state = again.get<RippleState>(pool);
        if (part == 0) {
            state.height.resize(7);
        } else if (part == 1) {
            state.dry.resize(3);
        } else if (part == 2) {
            state.stride = 2;
        } else if (part == 3) {
            state.previous.clear();
        } else {
            state.body.assign(2, 1.0f);
        }
        run_world(again, 2);
        CHECK(again.get<RippleState>(pool).steps == 2);
    }
}

TEST_CASE("ripple walls: sampled at a wall, the water is level with that next to it") {
    RippleState state = make_walled({4, 3}, kUndamped, [](const RippleState& made) {
        return std::vector<PlacedWall>{box(made, {0.5f, 1, 0.5f}, at({0, 0, 0}))};
    });
    for (int z = 0; z < state.cells.y; ++z) {
        for (int x = 0; x < state.cells.x; ++x) {
            const bool dry = state.dry[state.at(x, z)] != 0;
            state.height[state.at(x, z)] = dry ? 0 : 0.05f;
            state.previous[state.at(x, z)] = dry ? 0 : 0.05f;
        }
    }
    run(state, kUndamped, 2);
    for (const Vec2 p : {Vec2(0.5f, 0), Vec2(0.51f, 0.51f), Vec2(-0.2f, -0.5f)}) {
        const RipplePoint point = sample_ripples(state, p);
        CHECK(point.height == test::near(0.05).epsilon(1e-3).scale(0));
        CHECK(std::abs(point.slope.x) + std::abs(point.slope.y) < 1e-4f);
        CHECK(std::abs(point.velocity) < 1e-4f);
    }
    // What falls onto the wall makes no rings.
    push_ripples(state, {.center = {0, 0}, .radius = 2, .height = 0.3f});
    CHECK(
        max_height(state, [](const Vec2&) { return true; })
        == test::near(0.05).epsilon(1e-4).scale(0));
}

TEST_CASE("ripple walls: invalid or flat walls are ignored; a wall may cover the whole field") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Vec2 extent = {4, 3};
    CHECK(!place_wall({}, at({nan, 0, 0}), {}, 1, extent));
    CHECK(!place_wall({}, at({0, 1e30f, 0}), {}, 1, extent));
    CHECK(!place_wall({}, at({50, 0, 0}), {}, 1, extent));
    CHECK(!place_wall({.half = {nan, 1, 1}}, at({0, 0, 0}), {}, 1, extent));
    CHECK(!place_wall({.half = {0, 1, 1}}, at({0, 0, 0}), {}, 1, extent));
    World world;
    Schedule schedule = make_world_schedule();
    const Entity pool =
        world.create(Transform{}, Water{.size = extent, .depth = 1}, WaterRipples{.rain = 50});
    const Entity block = world.create(Transform{.position = {9, 0, 0}}, WaterWall{.half = Vec3(3)});
    const auto step = [&](int steps) {
        for (int i = 0; i < steps; ++i) {
            step_world(world, schedule);
        }
    };
    step(5);
    const RippleState& state = world.get<RippleState>(pool);
    CHECK(state.wet == state.cells.x * state.cells.y);
    world.get<Transform>(block).position.x = 0;
    step(5);
    CHECK(state.wet == 0);
    CHECK(ripple_volume(state) == 0);
    world.get<Transform>(block).position.x = 9;
    step(1);
    CHECK(std::abs(ripple_volume(state)) < 1e-5);
    step(40);
    CHECK(state.wet == state.cells.x * state.cells.y);
    CHECK(std::abs(ripple_volume(state)) < 1e-5);
    CHECK(max_height(state, [](const Vec2&) { return true; }) < 0.2f);
    world.get<Transform>(block).position.x = nan;
    step(5);
    CHECK(std::isfinite(ripple_volume(state)));
}

}  // namespace limn::water_ripple_walls_test
