// Particles from what cannot give any: one line for each, and nothing is lost.

#include "content/load/level/level_load.h"
#include "content/load/level/particle_warnings.h"
#include "ecs/components/all.h"
#include "ecs/components/name.h"
#include "ecs/components/particle_surface.h"
#include "ecs/components/particles.h"
#include "ecs/components/surface.h"
#include "ecs/components/trail.h"
#include "ecs/components/transform.h"
#include "ecs/field_access.h"
#include "ecs/reflect.h"
#include "ecs/world.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace limn::particle_warnings_test {
namespace {

using Lines = std::vector<std::string>;

Lines warnings_of(std::string_view text) {
    register_all_components();
    Result<Level> level = parse_level(text, "t.level.json");
    REQUIRE_MESSAGE(level.ok(), (level ? std::string() : level.error().message));
    World world;
    (void)spawn_level(world, *std::move(level));
    Lines lines;
    for (const SceneWarning& warning : find_scene_warnings(world)) {
        lines.push_back(warning.text);
    }
    return lines;
}

std::string error_of(const char* emitter) {
    register_all_components();
    const std::string text = fmt::format(
        R"({{"entities": [{{"name": "fire", "particle_look": {{}}, "particle_emitter": {{{}}}}}]}})",
        emitter);
    const Result<Level> level = parse_level(text, "t.level.json");
    REQUIRE_FALSE(level.ok());
    return level.error().message;
}

/// Of an emitter with these components beside it.
Lines warnings_beside(const char* components, const char* emitter = "") {
    return warnings_of(fmt::format(
        R"({{"entities": [{{"name": "fire", "particle_look": {{}}, "particle_emitter": {{{}}}{}}}]}})",
        emitter, components));
}

// ---- what has no effect, over all combinations

/// What a field is set to, so that it differs from its default.
void change_field(const FieldInfo& field, void* value) {
    if (field.shape == FieldShape::List) {
        field.list.resize(value, 1);
        value = element_ptr(field, value, 0);
    }
    const int numbers = number_count(field.type);
    if (numbers > 0) {
        for (const double wanted : {0.37, 0.9, 3.0, 0.0, 1.0, 300.0, 5000.0}) {
            bool differs = false;
            for (int lane = 0; lane < numbers; ++lane) {
                const double before = get_number(field, value, lane);
                differs = set_number(field, value, wanted, lane).ok() && wanted != before;
            }
            if (differs) {
                return;
            }
        }
    } else if (field.type == FieldType::Bool) {
        *static_cast<bool*>(value) = !*static_cast<bool*>(value);
    } else if (field.type == FieldType::Enum) {
        const std::uint64_t next = (get_unsigned(field, value) + 1) % field.values.size();
        CHECK(set_enum(field, value, field.values[next]).ok());
    } else if (field.type == FieldType::Entity) {
        static_cast<Entity*>(value)->index ^= 1u;
    } else if (field.type == FieldType::Asset) {
        *static_cast<std::uint32_t*>(value) = 0;
    } else if (field.type == FieldType::Struct) {
        for (const FieldInfo& inner : field.fields) {
            change_field(inner, field_ptr(value, inner));
        }
    }
}

/// An emitter with what is beside it, and the fields and components that are ignored there.
struct Situation {
    const char* emitter;
    const char* beside;
    std::vector<std::string_view> ignored;
};

using Names = std::vector<std::string_view>;

Names joined(Names a, const Names& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// Whatever the emitter is: fields of looks that need others.
const Names kLooks = {
    "particle_look.stretch",         "particle_look.camera_streak", "particle_look.attenuation",
    "particle_look.columns",         "particle_look.rows",          "particle_look.frames",
    "particle_look.frame_rate",      "particle_look.motion",        "particle_look.negative_light",
    "particle_look.motion_strength", "particle_look.shadow_tint"};
const Names kOnCpu = {"particle_look.sort", "particle_collision.collide_depth"};
const Names kOnGpu = {"particle_look.lit_at", "particle_look.culling"};
const Names kWaterLook = {"water_look.distortion",       "water_look.map_scale",
                          "water_look.floor_map",        "water_look.floor_tile",
                          "water_look.reflection_map",   "water_look.reflection_tile",
                          "water_look.reflection_height"};
/// Unless something beside it needs them.
const Names kEndless = {"particle_emitter.loop"};
const Names kDry = {"particle_emitter.loop", "particle_emitter.drop_speed"};
const Names kCalm = {
    "particle_motion.wind", "particle_motion.weather", "particle_motion.turbulence_size",
    "particle_motion.turbulence_speed"};
const Names kWithSource = {
    "particle_emitter.rate",    "particle_emitter.rate_curve",     "particle_emitter.rate_spread",
    "particle_emitter.bursts",  "particle_emitter.duration",       "particle_emitter.loop",
    "particle_emitter.prewarm", "particle_emitter.by_screen_area", "particle_emitter.inherit"};
const Names kClosed = {
    "particle_motion.drag",
    "particle_motion.wind",
    "particle_motion.weather",
    "particle_motion.turbulence",
    "particle_motion.turbulence_size",
    "particle_motion.turbulence_speed",
    "particle_motion.vortex",
    "particle_motion.attraction",
    "particle_motion.orbit",
    "particle_motion.brake",
    "particle_motion.fields"};

}  // namespace

TEST_CASE("particle warnings: two components that fill the same heights") {
    const Lines lines = warnings_of(R"({
        "images": {"hills": {"make": "marble", "size": 64}},
        "entities": [{
            "name": "ground", "transform": {}, "height_image": {"image": "hills.base_color"}, "noise_surface": {}
        }]
    })");
    const std::string wanted =
        R"(entity "ground": height_image and noise_surface fill the same heights: leave one out)";
    CHECK(std::count(lines.begin(), lines.end(), wanted) == 1);
}

TEST_CASE("bad emitter: rates, lifetimes and capacities that are refused, with what is expected") {
    const auto has = [](const std::string& message, std::string_view part) {
        CAPTURE(message);
        return message.find(part) != std::string::npos;
    };
    CHECK(has(
        error_of(R"("rate": -5)"),
        R"(t.level.json:1:82: entity "fire": particle_emitter.rate: found the number -5, expected a number 0 .. 10000000 1/s)"));
    CHECK(has(error_of(R"("rate": NaN)"), R"(t.level.json:1:82: found "N", expected a value)"));
    CHECK(has(error_of(R"("rate": 1e9)"), "found the number 1e9, expected a number 0 .. 10000000"));
    CHECK(has(error_of(R"("rate": 1e999)"), "t.level.json:1:82: "));
    CHECK(has(error_of(R"("life": -1)"), "found the number -1, expected a number 0 .. 100000 s"));
    CHECK(
        has(error_of(R"("capacity": 1000000000)"),
            "found the number 1000000000, expected an integer 0 .. 4194304"));
    CHECK(has(error_of(R"("capacity": 1.5)"), "expected an integer 0 .. 4194304"));
    CHECK(
        has(error_of(R"("rate_curve": [{"at": 1.5}])"), "rate_curve[0].at: found the number 1.5"));
}

TEST_CASE("bad emitter: a capacity or lifetime of zero is reported") {
    CHECK(warnings_beside("").empty());
    CHECK(
        warnings_beside("", R"("capacity": 0)")
        == Lines{R"(entity "fire": particle_emitter.capacity is 0: it emits nothing)"});
    CHECK(
        warnings_beside("", R"("life": 0, "life_spread": 0)")
        == Lines{R"(entity "fire": particle_emitter.life is 0 s: nothing is visible)"});
    CHECK(warnings_beside("", R"("life": 0)").empty());  // give or take half a second
}

TEST_CASE("bad emitter: a source that is itself, by itself or through others") {
    CHECK(
        warnings_beside(R"(, "particle_source": {"emitter": "fire"})")
        == Lines{R"(entity "fire": particle_source names itself: it emits nothing)"});
    CHECK(
        warnings_of(R"({"entities": [
            {"name": "a", "particle_look": {}, "particle_emitter": {}, "particle_source": {"emitter": "b"}},
            {"name": "b", "particle_look": {}, "particle_emitter": {}, "particle_source": {"emitter": "a"}},
            {"name": "c", "particle_look": {}, "particle_emitter": {}, "particle_source": {"emitter": "a"}}]})")
        == Lines{
            R"(entity "a": particle_source is part of a cycle: it emits nothing)",
            R"(entity "b": particle_source is part of a cycle: it emits nothing)"});
}

TEST_CASE("bad emitter: a flipbook with more frames than its image has pixels") {
    const auto of_image = [](std::uint32_t columns, std::uint32_t rows) {
        World world;
        ImageData& image = world.insert_resource(Assets{}).images.emplace_back();
        image.width = 16;
        image.height = 8;
        ParticleLook look;
        look.image = {0};
        look.columns = columns;
        look.rows = rows;
        world.create(Name{"fire"}, ParticleEmitter{}, ParticleLook(look));
        Lines lines;
        std::vector<SceneWarning> found;
        find_particle_warnings(world, found);
        for (const SceneWarning& warning : found) {
            lines.push_back(warning.text);
        }
        return lines;
    };
    CHECK(of_image(16, 8).empty());
    CHECK(
        of_image(17, 4)
        == Lines{R"(entity "fire": particle_look has 17 x 4 frames in an image of 16 x 8 pixels)"});
    CHECK(of_image(4, 64).size() == 1);
}

TEST_CASE("bad emitter: a mesh without triangles") {
    for (const char* const beside :
         {R"(, "particle_surface": {"on": "mesh"})", R"(, "particle_surface": {"on": "volume"})"}) {
        CHECK(
            warnings_beside(beside)
            == Lines{
                R"(entity "fire": particle_surface on a mesh needs an entity with mesh_instance)"});
    }
    World world;
    world.insert_resource(Assets{}).meshes.emplace_back();
    world.create(
        ParticleEmitter{}, ParticleLook{}, Transform{}, MeshInstance{.mesh = {0}, .material = {}},
        ParticleSurface{});
    std::vector<SceneWarning> found;
    find_particle_warnings(world, found);
    REQUIRE(found.size() == 1);
    CHECK(found[0].text.ends_with(
        "particle_surface is on a mesh without triangles: it emits nothing"));
}

TEST_CASE("bad emitter: dropped particles are reported with the limit to raise") {
    World world;
    ParticlePool pool;
    ParticleEmitter emitter;
    emitter.capacity = 78;
    world.create(Name{"fire"}, ParticleEmitter(emitter), ParticlePool(pool));
    CHECK(find_dropped_births(world).empty());
    pool.clock.dropped = 5;
    world.create(Name{"smoke"}, ParticleEmitter(emitter), ParticlePool(pool));
    const std::vector<SceneWarning> found = find_dropped_births(world);
    REQUIRE(found.size() == 1);
    CHECK(
        found[0].text
        == R"(entity "smoke": 5 new particles were dropped; particle_emitter.capacity is 78)");
}

TEST_CASE("no effect: each field of each component, set where it counts and where it does not") {
    register_all_components();
    const char* const kMotion = R"(, "particle_motion": {})";
    const char* const kCpu = R"("executor": "cpu")";
    const std::vector<Situation> situations = {
        {kCpu, kMotion, joined(kDry, kCalm)},
        {R"("executor": "gpu")", kMotion, joined(kDry, kCalm)},
        {R"("executor": "auto", "capacity": 300000)", kMotion, joined(kDry, kCalm)},
        {kCpu, R"(, "particle_motion": {"drag": 1, "turbulence": 1})", kDry},
        {kCpu, R"(, "particle_motion": {"integrator": "closed_form"})", joined(kDry, kClosed)},
        {R"("executor": "cpu", "duration": 3, "shape": "ball", "direction": "radial")",
         "",
         {"particle_emitter.cone", "particle_emitter.drop_speed"}},
        {kCpu, R"(, "particle_source": {"emitter": "other", "at": "hit"})",
         joined(kDry, kWithSource)},
        {kCpu, R"(, "particle_source": {"emitter": "other", "at": "flight"})",
         joined(
             joined(kDry, Names(kWithSource.begin() + 2, kWithSource.end())),
             {"particle_source.count", "particle_source.spread"})},
        {kCpu, R"(, "particle_surface": {"on": "mesh"}, "mesh_instance": {})",
         joined(
             kDry,
             {"particle_surface.path", "particle_surface.blast", "particle_emitter.inherit"})},
        {kCpu, R"(, "particle_surface": {"on": "pieces"}, "mesh_instance": {})",
         joined(
             kDry, {"particle_surface.path", "particle_surface.entity", "particle_surface.offset",
                    "particle_emitter.inherit"})},
        {kCpu, R"(, "particle_collision": {"action": "bounce"})", kDry},
        {R"("executor": "gpu")", R"(, "particle_collision": {"action": "stick"})",
         joined(kDry, {"particle_collision.bounce", "particle_collision.friction"})},
        {kCpu, R"(, "particle_collider": {"shape": "sphere"})",
         joined(kDry, {"particle_collider.ripple", "particle_collider.ripple_radius"})},
        {kCpu, R"(, "particle_collider": {"shape": "plane"})",
         joined(
             kDry, {"particle_collider.size", "particle_collider.hollow",
                    "particle_collider.ripple", "particle_collider.ripple_radius"})},
        {kCpu, R"(, "particle_collider": {"shape": "water"}, "water": {}, "water_ripples": {})",
         joined(kDry, {"particle_collider.size", "particle_collider.hollow"})},
        {kCpu, R"(, "water": {}, "ocean": {}, "spray_source": {})",
         joined(kEndless, {"spray_source.steepness", "ocean.gamma", "ocean.fetch"})},
        {kCpu, R"(, "water": {"size": [9, 9]}, "water_waves": {}, "spray_source": {})",
         joined(kEndless, {"spray_source.window"})},
        {kCpu, R"(, "water": {}, "ocean": {"spectrum": "tma"}, "water_look": {})",
         joined(kDry, joined(kWaterLook, {"water_look.foam_decay"}))},
        {kCpu, R"(, "water": {}, "water_look": {"reflection": "planar", "foam_below": -1})",
         joined(
             kDry, joined(
                       Names(kWaterLook.begin() + 2, kWaterLook.end()),
                       {"water_look.foam_below", "water_look.foam_decay"}))},
        {kCpu,
         R"(, "water": {"depth": 2}, "water_look": {"reflection": "map", "refraction": "floor"})",
         joined(
             kDry, {"water_look.distortion", "water_look.map_scale", "water_look.foam_below",
                    "water_look.foam_decay"})},
        {kCpu,
         R"(, "water": {}, "water_waves": {"waves": [{}]}, "water_look": {"foam_below": 0.5}, "water_detail": {"split": 1})",
         joined(joined(kDry, kWaterLook), {"water_detail.normal_map", "water_detail.layers"})},
        {kCpu, R"(, "water": {}, "water_detail": {"layers": [{}]}, "water_ripples": {"rain": 5})",
         joined(kDry, {"water_detail.layers", "water_detail.split", "water_detail.tile"})},
        {kCpu,
         R"(, "water": {"size": [8, 8]}, "water_ripples": {}, "caustics": {}, "force_field": {})",
         joined(
             kDry, {"water_ripples.window", "caustics.window", "caustics.cascades",
                    "caustics.mirror_resolution", "force_field.speed", "force_field.phase"})},
        {kCpu,
         R"(, "water": {}, "caustics": {"mirror_reach": 3}, "force_field": {"kind": "wind", "frequency": 1})",
         kDry},
        {kCpu, R"(, "spray_obstacle": {}, "water_touch": {"shape": "mesh"}, "mesh_instance": {})",
         joined(kEndless, {"spray_obstacle.normal", "water_touch.half", "water_touch.offset"})},
        {kCpu, R"(, "spray_obstacle": {}, "particle_collider": {"shape": "plane"})",
         joined(
             kEndless, {"particle_collider.size", "particle_collider.hollow",
                        "particle_collider.ripple", "particle_collider.ripple_radius"})},
        {kCpu, R"(, "trail": {"path": "births"})",
         joined(kDry, {"trail.active", "trail.length", "trail.life", "trail.count", "trail.span"})},
        {kCpu, R"(, "trail": {"path": "particles"})", joined(kDry, {"trail.span"})},
        {kCpu, R"(, "trail": {})", joined(kDry, {"trail.count"})},
    };
    const auto has = [](const Names& names, const std::string& name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    std::size_t walked = 0;
    for (const Situation& situation : situations) {
        CAPTURE(std::string(situation.emitter));
        CAPTURE(std::string(situation.beside));
        Result<Level> level = parse_level(
            fmt::format(
                R"({{"entities": [{{"name": "other", "particle_emitter": {{}}, "particle_look": {{}}}},
                {{"name": "fire", "particle_look": {{"lit": 1}}, "particle_emitter": {{{}}}{}}}]}})",
                situation.emitter, situation.beside),
            "t.level.json");
        REQUIRE_MESSAGE(level.ok(), (level ? std::string() : level.error().message));
        World world;
        (void)spawn_level(world, *std::move(level));
        Entity fire;
        world.query<const Name>().each(
            [&](Entity entity, const Name& name) { fire = name.text == "fire" ? entity : fire; });
        for (const ComponentInfo* const info : all_components()) {
            const bool counts = info->name.starts_with("particle_")
                                || info->name.starts_with("water_")
                                || info->name.starts_with("spray_")
                                || has({"ocean", "caustics", "force_field", "trail"}, info->name);
            if (!counts || !world.has(fire, info->id) || info->name == "particle_pool") {
                continue;
            }
            for (const FieldInfo& field : info->fields) {
                const std::string name = fmt::format("{}.{}", info->name, field.name);
                CAPTURE(name);
                AnyComponent before(*info, world.find(fire, info->id));
                change_field(field, field_ptr(world.find(fire, info->id), field));
                std::vector<SceneWarning> found;
                find_particle_warnings(world, found);
                const auto told = std::count_if(found.begin(), found.end(), [&](const auto& one) {
                    return one.text.starts_with(
                        fmt::format("entity \"fire\": {} has no effect ", name));
                });
                const bool on_gpu = runs_on_gpu(world.get<const ParticleEmitter>(fire));
                // What a field is changed to may change what it is in.
                const bool is_switch =
                    has({"particle_emitter.executor", "particle_emitter.capacity"}, name);
                const bool is_quad = !world.has<Trail>(fire);  // which reads a look in other ways
                const bool expected = has(situation.ignored, name) || (is_quad && has(kLooks, name))
                                      || has(on_gpu ? kOnGpu : kOnCpu, name);
                CHECK((is_switch || told == (expected ? 1 : 0)));
                CHECK(told <= 1);
                world.remove(fire, info->id);
                world.add_copy(fire, info->id, before.data());
                ++walked;
            }
        }
    }
    CHECK(walked > 1700);
}

TEST_CASE("no effect: each component beside an emitter, on either executor") {
    struct Row {
        const char* component;
        bool on_cpu;
        bool on_gpu;
    };
    for (const Row& row : std::initializer_list<Row>{
             {"particle_mesh", true, false},
             {"particle_light", true, false},
             {"particle_surface", true, true},
             {"particle_balls", true, true},
             {"trail", true, false},
             {"particle_motion", true, true},
             {"particle_wrap", true, true},
             {"particle_collision", true, true}}) {
        for (const bool gpu : {false, true}) {
            CAPTURE(row.component);
            CAPTURE(gpu);
            const Lines lines = warnings_beside(
                fmt::format(
                    R"(, "{}": {{}}, "mesh_instance": {{}}, "particle_collider": {{}})",
                    row.component)
                    .c_str(),
                gpu ? R"("executor": "gpu")" : R"("executor": "cpu")");
            const auto told = std::count_if(lines.begin(), lines.end(), [&](const auto& line) {
                return line.find(fmt::format("{} has no effect on", row.component))
                       != std::string::npos;
            });
            CHECK(told == ((gpu ? row.on_gpu : row.on_cpu) ? 0 : 1));
        }
    }
    CHECK(
        warnings_beside(R"(, "water": {}, "water_look": {"refraction": "floor"})").at(0)
        == R"(entity "fire": water_look.refraction has no effect as a floor without a water.depth)");
    // Of two reasons the first is told, and of a component that is ignored no field.
    const Lines lines = warnings_beside(
        R"(, "particle_wrap": {}, "particle_collider": {}, "particle_collision": {"action": "stick", "bounce": 0.9})",
        R"("executor": "gpu")");
    CHECK(
        lines
        == Lines{R"(entity "fire": particle_collision has no effect beside a particle_wrap)"});
}

TEST_CASE("particle warnings: a trail without effect hides no fields that particles ignore") {
    const auto warns_of_stretch = [](const char* executor) {
        const Lines lines = warnings_of(fmt::format(
            R"({{"entities": [{{"name": "fire", "particle_look": {{"stretch": 3}}, "trail": {{}},
            "particle_emitter": {{"executor": "{}"}}}}]}})",
            executor));
        return std::any_of(lines.begin(), lines.end(), [](const std::string& line) {
            return line.find("particle_look.stretch has no effect") != std::string::npos;
        });
    };
    CHECK(warns_of_stretch("gpu"));
    CHECK_FALSE(warns_of_stretch("cpu"));  // which draws a ribbon
}

}  // namespace limn::particle_warnings_test
