#include "content/game/game.h"
#include "content/game/sailboat.h"
#include "content/game/sailing.h"
#include "content/game/sailing_system.h"
#include "ecs/base/jobs.h"
#include "ecs/base/rotation.h"
#include "ecs/components/buoyancy.h"
#include "ecs/components/camera.h"
#include "ecs/components/surface.h"
#include "ecs/components/water_wake.h"
#include "ecs/components/weather.h"
#include "ecs/hierarchy.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"
#include "systems/update_world.h"
#include "systems/water/floating_body.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace limn::sailing_test {

namespace {

constexpr float kStep = 1.0f / 60;

/// A keelboat of 6 m on still, unbounded water, its bow toward +z.
struct Boat {
    WaterSurface surface{};
    WaterTouch touch{.shape = TouchShape::Box, .half = {0.75f, 0.3f, 3.0f}};
    FloatingState body{};
    Floating floating{
        .density = 420,
        .center_of_mass = {0, -0.55f, 0},
        .drag = {1.1f, 1.1f, 0.06f},
        .damping = 0.03f};
    Transform transform{.position = {0, 0.05f, 0}};
    Sailboat settings{};
    SailboatState boat{};
    Vec3 wind = {0, 0, 0};

    void step() {
        if (boat.auto_trim) {
            trim_sail(
                settings, floating, body, transform.rotation, transform.scale, wind, kStep, boat);
        }
        step_sailboat({&surface, 1}, wind, touch, floating, transform, settings, kStep, boat, body);
        (void)step_floating_body({&surface, 1}, touch, floating, kStep, body, transform);
    }
    void run(float seconds) {
        for (int i = 0; i < static_cast<int>(seconds / kStep); ++i) {
            step();
        }
    }
    /// As a hand at the helm does it who wants to go straight on.
    void run_straight(float seconds) {
        const float wanted = heading_of(transform.rotation);
        for (int i = 0; i < static_cast<int>(seconds / kStep); ++i) {
            const float off = std::remainder(wanted - heading_of(transform.rotation), 2 * kPi);
            const float astern = ahead() < -0.05f ? -1.0f : 1.0f;
            boat.rudder = std::clamp(astern * (2.5f * off + 1.5f * body.spin.y), -1.0f, 1.0f);
            step();
        }
    }
    [[nodiscard]] float ahead() const {
        return glm::dot(body.velocity, transform.rotation * Vec3(0, 0, 1));
    }
    /// > 0: to port (+x) [rad].
    [[nodiscard]] float heel() const {
        return -std::asin(std::clamp((transform.rotation * Vec3(1, 0, 0)).y, -1.0f, 1.0f));
    }
    [[nodiscard]] float energy() const {
        const BodyMass mass = body_mass(touch, floating, transform.scale);
        const Vec3 spin = glm::conjugate(transform.rotation) * body.spin;
        return 0.5f * mass.mass * glm::dot(body.velocity, body.velocity)
               + 0.5f * glm::dot(mass.inertia * spin, spin);
    }
    [[nodiscard]] bool is_finite() const {
        const Vec3 sum = transform.position + body.velocity + body.spin;
        return std::isfinite(sum.x + sum.y + sum.z + transform.rotation.w + boat.boom + boat.sheet);
    }
};

/// Wind that comes from `off` the bow, > 0 from starboard [rad].
Vec3 wind_from(float off, float speed) {
    // The bow is +z, starboard is -x.
    return -speed * Vec3(-std::sin(off), 0, std::cos(off));
}

/// How fast it goes in the end, straight on.
float speed_at(float off, float speed = 8) {
    Boat boat;
    boat.wind = wind_from(off, speed);
    boat.run_straight(60);
    return boat.ahead();
}

}  // namespace

TEST_CASE("sailing: a foil lifts to the side that the flow comes from, as much on either") {
    for (const float degrees : {1.0f, 5.0f, 15.0f, 24.0f, 45.0f, 80.0f, 110.0f, 179.0f}) {
        CAPTURE(degrees);
        const FoilForce one = foil_force(radians(degrees));
        const FoilForce other = foil_force(-radians(degrees));
        CHECK(one.lift == test::near(-other.lift));
        CHECK(one.drag == test::near(other.drag));
        CHECK(one.drag > 0);
        CHECK(one.lift * (90 - degrees) >= 0);
    }
    CHECK(foil_force(0).lift == 0);
    // Before the stall lift is several times the drag, after it is not.
    CHECK(foil_force(radians(8.0f)).lift > 6 * foil_force(radians(8.0f)).drag);
    CHECK(foil_force(radians(50.0f)).lift < 1.5f * foil_force(radians(50.0f)).drag);
    CHECK(foil_force(radians(90.0f)).drag > 1.1f);
}

TEST_CASE("sailing: without wind it comes to rest, and never speeds up") {
    Boat boat;
    boat.run(5);
    boat.body.velocity = {0.5f, 0, 3};
    float before = boat.energy() * 1.05f;
    for (int second = 0; second < 240; ++second) {
        boat.run(1);
        CHECK(boat.energy() <= before + 0.05f);
        before = boat.energy();
    }
    CHECK(glm::length(boat.body.velocity) < 0.1f);
    CHECK(glm::length(boat.body.spin) < 0.01f);
}

TEST_CASE("sailing: nobody sails into the wind") {
    for (const float off : {-0.15f, 0.0f, 0.1f}) {
        CAPTURE(off);
        Boat boat;
        boat.wind = wind_from(off, 8);
        boat.boat.auto_trim = false;
        for (const float sheet : {0.0f, 0.5f, 1.0f}) {
            boat.boat.sheet = sheet;
            boat.run_straight(8);
            CHECK(boat.ahead() < 0.15f);
        }
        CHECK(boat.transform.position.z < 0.5f);
    }
}

TEST_CASE("sailing: a beam reach is faster than running, and that than beating") {
    const float reach = speed_at(radians(95.0f));
    const float run = speed_at(radians(178.0f));
    const float beat = speed_at(radians(42.0f));
    MESSAGE("reach " << reach << ", run " << run << ", beat " << beat << " m/s in 8 m/s of wind");
    CHECK(reach > 1.15f * run);
    CHECK(reach > 1.08f * beat);
    CHECK(beat > 0.8f);
    CHECK(run > 1.0f);
    CHECK(reach < 8);
}

TEST_CASE("sailing: more wind is more speed, until the hull's own waves are too long") {
    const float light = speed_at(radians(95.0f), 3);
    const float fresh = speed_at(radians(95.0f), 6);
    const float strong = speed_at(radians(95.0f), 12);
    CHECK(fresh > 1.6f * light);
    CHECK(strong > fresh);
    MESSAGE("in 3, 6 and 12 m/s: " << light << ", " << fresh << ", " << strong << " m/s");
    CHECK(strong < 1.6f * fresh);
}

TEST_CASE("sailing: it heels to leeward and rights itself when the wind drops") {
    Boat boat;
    boat.wind = wind_from(radians(80.0f), 9);  // from starboard
    boat.run_straight(20);
    CHECK(boat.heel() > radians(3.0f));  // to port
    CHECK(boat.heel() < radians(40.0f));
    CHECK(boat.boat.boom > 0);
    boat.wind = Vec3(0);
    boat.run(30);
    CHECK(std::abs(boat.heel()) < radians(0.5f));
}

TEST_CASE("sailing: it turns to the side that the rudder is on") {
    for (const float rudder : {-1.0f, -0.3f, 0.3f, 1.0f}) {
        CAPTURE(rudder);
        Boat boat;
        boat.body.velocity = {0, 0, 3};
        boat.boat.rudder = rudder;
        const float before = heading_of(boat.transform.rotation);
        boat.run(2);
        const float turned = std::remainder(heading_of(boat.transform.rotation) - before, 2 * kPi);
        CHECK(turned * rudder > 0.02f);  // to starboard headings grow
        CHECK(boat.transform.position.x * rudder < 0);
    }
}

TEST_CASE("sailing: the rudder of a boat at rest has no effect") {
    Boat boat;
    boat.run(3);
    boat.boat.rudder = 1;
    boat.run(3);
    CHECK(heading_of(boat.transform.rotation) == test::near(kPi / 2).epsilon(1e-3));
}

TEST_CASE("sailing: a mirrored boat sails the mirrored course") {
    Boat one;
    Boat other;
    one.wind = {5, 0, 3};
    other.wind = {-5, 0, 3};
    one.boat.rudder = 0.15f;
    other.boat.rudder = -0.15f;
    one.boat.boom = 0.1f;  // on its side from the beginning
    other.boat.boom = -0.1f;
    for (int second = 0; second < 20; ++second) {
        one.run(1);
        other.run(1);
        CHECK(one.transform.position.x == test::near(-other.transform.position.x).epsilon(1e-3));
        CHECK(one.transform.position.z == test::near(other.transform.position.z).epsilon(1e-3));
        CHECK(one.heel() == test::near(-other.heel()).epsilon(1e-2));
        CHECK(one.boat.boom == test::near(-other.boat.boom).epsilon(1e-2));
    }
    CHECK(std::abs(one.transform.position.x) > 1);
}

TEST_CASE("sailing: no rig makes the boat much faster than the wind") {
    // Whatever the rig: no part of it is ever faster than the wind could make it.
    for (const float area : {16.0f, 200.0f, 1e4f}) {
        for (const float wind : {2.0f, 60.0f}) {
            CAPTURE(area);
            CAPTURE(wind);
            Boat boat;
            boat.settings.sail_area = area;
            boat.settings.keel_area = area;
            boat.settings.rudder_area = area;
            float most = 0;
            for (int second = 0; second < 20; ++second) {
                const auto turn = static_cast<float>(second);
                boat.wind = wind * Vec3(std::cos(2 * turn), 0, std::sin(2 * turn));
                boat.boat.rudder = std::sin(3 * turn);
                boat.run(1);
                most = std::max(most, glm::length(boat.body.velocity));
            }
            CHECK(boat.is_finite());
            CHECK(most < 2.5f * wind + 3);
        }
    }
}

TEST_CASE("sailing: NaN, infinite and extreme values give finite results") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    for (const float bad : {nan, inf, -inf, -1.0f, 0.0f, 1e30f}) {
        CAPTURE(bad);
        for (int field = 0; field < 9; ++field) {
            CAPTURE(field);
            Boat boat;
            boat.wind = {5, 0, 2};
            switch (field) {
            case 0:
                boat.wind.x = bad;
                break;
            case 1:
                boat.settings.sail_area = bad;
                break;
            case 2:
                boat.settings.keel_area = bad;
                break;
            case 3:
                boat.boat.rudder = bad;
                break;
            case 4:
                boat.boat.sheet = bad;
                break;
            case 5:
                boat.boat.boom = bad;
                break;
            case 6:
                boat.settings.wave_drag = bad;
                break;
            case 7:
                boat.settings.sail_center.y = bad;
                break;
            default:
                boat.touch.half.z = bad;
                break;
            }
            boat.run(1);
            const Vec3 sum = boat.transform.position + boat.body.velocity + boat.body.spin;
            CHECK(std::isfinite(sum.x + sum.y + sum.z + boat.transform.rotation.w));
        }
    }
}

TEST_CASE("sailing: it reaches a mark to windward by tacks, and one to leeward straight") {
    for (const float z : {120.0f, -120.0f}) {
        CAPTURE(z);
        PathShape shape;
        shape.knots = {{.position = {0, 0, 0.5f * z}}, {.position = {0, 0, z}}};
        const PathData course = *make_path(shape);
        Boat boat;
        boat.wind = {0.3f, 0, -7};  // from +z
        boat.transform.rotation = rotation_about({0, 1, 0}, 0.8f);
        int tacks = 0;
        float wide = 0;
        bool there = false;
        for (int i = 0; i < 60 * 240 && !there; ++i) {
            const int before = boat.boat.tack;
            follow_course(course, boat.touch, boat.body, boat.transform, boat.wind, boat.boat);
            boat.step();
            tacks += static_cast<int>(boat.boat.tack != before);
            wide = std::max(wide, std::abs(boat.transform.position.x));
            there = std::abs(boat.transform.position.z - z) < 20;
        }
        CHECK(there);
        if (z > 0) {
            CHECK(tacks >= 1);
            CHECK(wide > 10);
        } else {
            CHECK(wide < 15);
        }
    }
}

// ---- in a world ---------------------------------------------------------------------------------

namespace {

struct Bay {
    World world;
    Schedule schedule = make_world_schedule(add_game_systems);
    Entity sea;

    explicit Bay(const Weather& weather = {.wind_speed = 7, .wind_direction = 0.3f}) {
        register_game_components();
        world.insert_resource(weather);
        sea = world.create(Transform{}, WorldTransform{}, Water{});
    }
    Entity add_boat(const Vec3& at, const Sailboat& sailboat = {}) {
        const Boat model;
        return world.create(
            Transform{.position = at}, model.touch, model.floating, sailboat, WakeEmitter{});
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            step_world(world, schedule);
        }
    }
};

}  // namespace

TEST_CASE("sailing: a player's boat is autonomous until a key is used") {
    Bay bay;
    const Entity boat = bay.add_boat({0, 0, 0}, {.player = true});
    start_world(bay.world, add_game_systems);
    bay.run(30);
    CHECK(!bay.world.get<SailboatState>(boat).player_active);
    Input& input = bay.world.resource<Input>();
    set_action(input, "rudder_starboard");
    set_action(input, "sheet_out");
    bay.run(60);
    CHECK(bay.world.get<SailboatState>(boat).player_active);
    CHECK(bay.world.get<SailboatState>(boat).rudder == test::near(1));
    const float sheet = bay.world.get<SailboatState>(boat).sheet;
    input = {};
    set_action(input, "rudder_port");
    set_action(input, "sheet_in");
    bay.run(60);
    CHECK(bay.world.get<SailboatState>(boat).rudder < 0);
    CHECK(bay.world.get<SailboatState>(boat).sheet < sheet);
    CHECK(!bay.world.get<SailboatState>(boat).auto_trim);
    set_action(input, "auto_trim");
    bay.run(1);
    CHECK(bay.world.get<SailboatState>(boat).auto_trim);
}

TEST_CASE("sailing: the keys steer only while the boat's camera is active") {
    Bay bay;
    const Entity camera = bay.world.create(Transform{}, Camera{.active = false});
    const Entity boat = bay.add_boat({0, 0, 0}, {.player = true, .camera = camera});
    start_world(bay.world, add_game_systems);
    set_action(bay.world.resource<Input>(), "rudder_starboard");
    bay.run(30);
    CHECK(!bay.world.get<SailboatState>(boat).player_active);
    bay.world.get<Camera>(camera).active = true;
    bay.run(30);
    CHECK(bay.world.get<SailboatState>(boat).player_active);
}

TEST_CASE("sailing: a boom swings to leeward and its sail fills to the same side") {
    Bay bay({.wind_speed = 7, .wind_direction = 0});  // toward +x: port of a bow at +z
    const Entity boat = bay.add_boat({0, 0, 0});
    const Entity boom = bay.world.create(Transform{}, Boom{}, Parent{boat});
    start_world(bay.world, add_game_systems);
    bay.run(120);
    const auto& swung = bay.world.get<Transform>(boom);
    CHECK((swung.rotation * Vec3(0, 0, -1)).x > 0.1f);
    CHECK(swung.scale.x > 0.5f);
}

TEST_CASE("sailing: a lookout moves with its boat and stays upright") {
    Bay bay({.wind_speed = 11, .wind_direction = 0});
    const Entity lookout = bay.world.create(Transform{});
    const Entity boat = bay.add_boat({0, 0, 0}, {.camera_target = lookout});
    start_world(bay.world, add_game_systems);
    bay.run(120);
    const auto& hull = bay.world.get<Transform>(boat);
    const auto& upright = bay.world.get<Transform>(lookout);
    CHECK((hull.rotation * Vec3(0, 1, 0)).y < 0.999f);  // it heels
    CHECK((upright.rotation * Vec3(0, 1, 0)).y == test::near(1));
    CHECK(upright.position == hull.position);
    CHECK(heading_of(upright.rotation) == test::near(heading_of(hull.rotation)));
}

TEST_CASE("sailing: fifty boats end at the same positions for any number of threads, to the bit") {
    const auto sail = [](int threads) {
        const int before = thread_count();
        set_thread_count(threads);
        Bay bay;
        for (int i = 0; i < 50; ++i) {
            bay.add_boat({static_cast<float>(12 * i), 0, 0});
        }
        start_world(bay.world, add_game_systems);
        bay.run(60);
        const std::uint64_t hash = state_hash(bay.world);
        set_thread_count(before);
        return hash;
    };
    CHECK(sail(1) == sail(3));
}

}  // namespace limn::sailing_test
