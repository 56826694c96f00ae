#include "content/load/level/color_names.h"
#include "content/load/level/component_json.h"
#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "ecs/components/all.h"
#include "ecs/components/camera.h"
#include "ecs/components/light.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/field_access.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace limn::component_json_test {
namespace {

enum class Mood : std::uint8_t { Calm, Busy, Wild };

struct Knob {
    float turn = 0.5f;
    int clicks = 3;
};

template <typename Visitor>
void visit_fields(Knob& knob, Visitor&& visit) {
    visit("turn", knob.turn, {.unit = "rad", .min = -10, .max = 10});
    visit("clicks", knob.clicks, {.min = 0, .max = 9});
}

/// A field of every kind that reflection knows.
struct Everything {
    bool on = false;
    std::int8_t small = -1;
    std::uint64_t large = 0;
    std::int64_t far = 0;
    double fine = 0.5;
    Vec2 flat = {1, 2};
    Vec3 tint = {1, 1, 1};
    Vec4 glass = {1, 1, 1, 0.5f};
    Quat turn = {1, 0, 0, 0};
    IVec3 cell = {1, 2, 3};
    Mat3 frame = Mat3(1.0f);
    Affine place;
    std::string label = "x";
    Mood mood = Mood::Calm;
    Entity friend_of;
    MeshId mesh;
    Knob knob;
    std::array<float, 3> triple = {1, 2, 3};
    std::vector<Knob> knobs;
    std::vector<std::string> words;
};

template <typename Visitor>
void visit_fields(Everything& all, Visitor&& visit) {
    visit("on", all.on);
    visit("small", all.small);
    visit("large", all.large);
    visit("far", all.far);
    visit("fine", all.fine);
    visit("flat", all.flat);
    visit("tint", all.tint, {.min = 0, .max = 1, .color = true});
    visit("glass", all.glass, {.min = 0, .max = 1, .color = true});
    visit("turn", all.turn);
    visit("cell", all.cell);
    visit("frame", all.frame);
    visit("place", all.place);
    visit("label", all.label);
    visit("mood", all.mood, {.values = "calm busy wild"});
    visit("friend_of", all.friend_of);
    visit("mesh", all.mesh);
    visit("knob", all.knob);
    visit("triple", all.triple);
    visit("knobs", all.knobs);
    visit("words", all.words);
}

struct Renamed {
    float size = 1;
    Mood mood = Mood::Calm;
};

template <typename Visitor>
void visit_fields(Renamed& value, Visitor&& visit) {
    visit("size", value.size, {.min = 0, .renamed = "largeness bigness"});
    visit("mood", value.mood, {.values = "calm busy wild", .renamed = "temper lazy=calm mad=wild"});
}

/// A field of each unit that can be written in other ways.
struct Measures {
    float angle = 0;
    float turn = 0;
    float length = 0;
    Vec3 place = {0, 0, 0};
    float speed = 0;
    float time = 0;
    float plain = 0;
};

template <typename Visitor>
void visit_fields(Measures& value, Visitor&& visit) {
    visit("angle", value.angle, {.unit = "rad", .min = -3.2, .max = 3.2});
    visit("turn", value.turn, {.unit = "rad/s"});
    visit("length", value.length, {.unit = "m", .min = 0});
    visit("place", value.place, {.unit = "m"});
    visit("speed", value.speed, {.unit = "m/s"});
    visit("time", value.time, {.unit = "s"});
    visit("plain", value.plain);
}

NameResolver some_names() {
    NameResolver names;
    names.asset = [](std::string_view kind, std::string_view name,
                     SourcePosition) -> std::optional<std::uint32_t> {
        return kind == "mesh" && name == "teapot" ? std::optional<std::uint32_t>(7) : std::nullopt;
    };
    names.entity = [](std::string_view name, SourcePosition) -> std::optional<Entity> {
        return name == "lamp" ? std::optional<Entity>(Entity{4, 2}) : std::nullopt;
    };
    names.all = [](std::string_view kind) -> std::vector<std::string_view> {
        return {kind == "mesh" ? "teapot" : "lamp"};
    };
    return names;
}

template <typename T>
T read(std::string_view text) {
    const Result<JsonValue> json = parse_json(text, "t.json");
    REQUIRE(json.ok());
    T value{};
    const Status status = read_struct(*json, value, {"t.json", "thing"}, some_names());
    REQUIRE_MESSAGE(status.ok(), (status.ok() ? "" : status.error().message));
    return value;
}

template <typename T>
std::string error_of(std::string_view text) {
    const Result<JsonValue> json = parse_json(text, "t.json");
    REQUIRE(json.ok());
    T value{};
    const Status status = read_struct(*json, value, {"t.json", "thing"}, some_names());
    REQUIRE(!status.ok());
    return status.error().message;
}

bool same(const ComponentInfo& info, const void* a, const void* b) {
    for (const FieldInfo& field : info.fields) {
        const void* const in_a = field_ptr(a, field);
        const void* const in_b = field_ptr(b, field);
        if (element_count(field, in_a) != element_count(field, in_b)) {
            return false;
        }
        for (std::size_t i = 0; i < element_count(field, in_a); ++i) {
            if (!equal_elements(field, element_ptr(field, in_a, i), element_ptr(field, in_b, i))) {
                return false;
            }
        }
    }
    return true;
}

}  // namespace

TEST_CASE("component json: a field of every type is read") {
    const auto all = read<Everything>(R"({
        "on": true, "small": -128, "large": 18446744073709551615, "far": -9223372036854775808,
        "fine": 0.1, "flat": [3, 4], "tint": [0.25, 0.5, 1], "glass": [0, 0.5, 1, 0.25],
        "turn": [0, 2, 0, 0], "cell": [-1, 0, 1], "frame": [1, 2, 3, 4, 5, 6, 7, 8, 9],
        "place": [1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7], "label": "text", "mood": "wild",
        "friend_of": "lamp", "mesh": "teapot", "knob": {"turn": "90deg"}, "triple": [4, 5, 6],
        "knobs": [{"clicks": 1}, {}], "words": ["a", "b"]
    })");
    CHECK(all.on);
    CHECK(all.small == -128);
    CHECK(all.large == 18446744073709551615u);
    CHECK(all.far == std::numeric_limits<std::int64_t>::min());
    CHECK(all.fine == 0.1);
    CHECK(all.flat == Vec2(3, 4));
    CHECK(all.tint == Vec3(0.25f, 0.5f, 1));
    CHECK(all.turn == Quat(0, 0, 1, 0));  // normalized
    CHECK(all.cell == IVec3(-1, 0, 1));
    CHECK(all.frame[0] == Vec3(1, 2, 3));
    CHECK(all.place.row[2] == Vec4(0, 0, 1, 7));
    CHECK(all.label == "text");
    CHECK(all.mood == Mood::Wild);
    CHECK(all.friend_of == Entity{4, 2});
    CHECK(all.mesh.index == 7);
    CHECK(all.knob.turn == test::near(1.5707963f));
    CHECK(all.knob.clicks == 3);
    CHECK(all.triple[2] == 6.0f);
    REQUIRE(all.knobs.size() == 2);
    CHECK(all.knobs[0].clicks == 1);
    CHECK(all.knobs[1].clicks == 3);
    CHECK(all.words == std::vector<std::string>{"a", "b"});
}

TEST_CASE("component json: fields that are not named keep their values") {
    Knob knob{.turn = 0.25f, .clicks = 7};
    const Result<JsonValue> json = parse_json(R"({"turn": 1})", "t.json");
    REQUIRE(json.ok());
    REQUIRE(read_struct(*json, knob, {"t.json", ""}, {}).ok());
    CHECK(knob.turn == 1.0f);
    CHECK(knob.clicks == 7);
}

TEST_CASE("component json: null is no entity and no asset") {
    const auto all = read<Everything>(R"({"friend_of": null, "mesh": null})");
    CHECK(all.friend_of.is_null());
    CHECK(all.mesh.index == kNoAsset);
}

TEST_CASE("component json: a color may be written in sRGB, and its alpha left out") {
    const auto all = read<Everything>(R"({"tint": "#ff8000", "glass": "#00ff0080"})");
    CHECK(all.tint.x == 1.0f);
    CHECK(all.tint.y == test::near(0.2158605f));  // (128 / 255) decoded
    CHECK(all.tint.z == 0.0f);
    CHECK(all.glass == Vec4(0, 1, 0, 128.0f / 255.0f));
    CHECK(read<Everything>(R"({"glass": [0, 0, 1]})").glass == Vec4(0, 0, 1, 0.5f));
    CHECK(read<Everything>(R"({"glass": "#0000ff"})").glass == Vec4(0, 0, 1, 0.5f));
    // One digit a channel stands for two.
    CHECK(
        read<Everything>(R"({"tint": "#f80"})").tint
        == read<Everything>(R"({"tint": "#ff8800"})").tint);
    CHECK(
        read<Everything>(R"({"glass": "#f80a"})").glass
        == read<Everything>(R"({"glass": "#ff8800aa"})").glass);
    CHECK(read<Everything>(R"({"glass": "#00f"})").glass == Vec4(0, 0, 1, 0.5f));
}

TEST_CASE("component json: a color may be named as in CSS, which keeps the alpha") {
    const auto code_of = [](std::string_view name) { return find_color(name).value_or(1); };
    CHECK(code_of("aliceblue") == 0xf0f8ff);  // the first and the last
    CHECK(code_of("yellowgreen") == 0x9acd32);
    CHECK(code_of("gray") == 0x808080);  // not that of X11
    CHECK(code_of("green") == 0x008000);
    CHECK(code_of("rebeccapurple") == 0x663399);
    CHECK_FALSE(find_color("Orange"));
    CHECK_FALSE(find_color(""));
    const std::vector<std::string_view> names = color_names();
    CHECK(names.size() == 148);
    CHECK(std::is_sorted(names.begin(), names.end()));
    for (const std::string_view name : names) {
        CAPTURE(name);
        const auto named =
            read<Everything>(fmt::format(R"({{"tint": "{0}", "glass": "{0}"}})", name));
        const std::string code = fmt::format("#{:06x}", code_of(name));
        const auto coded =
            read<Everything>(fmt::format(R"({{"tint": "{0}", "glass": "{0}"}})", code));
        CHECK(named.tint == coded.tint);
        CHECK(named.glass == coded.glass);
        CHECK(named.glass.w == 0.5f);
    }
    CHECK(
        error_of<Everything>(R"({"tint": "ornage"})")
        == "t.json:1:10: thing.tint: found the string \"ornage\", expected [r, g, b], "
           "\"#rrggbb\", \"#rgb\" or a name such as \"orange\" (did you mean orange?)");
}

TEST_CASE("component json: angles turn about y, then x, then z") {
    const Quat q = rotation_from_degrees({90, 0, 0});
    const Vec3 ahead = q * Vec3(0, 0, -1);
    CHECK(ahead.x == test::near(-1.0f));  // yaw turns to the left
    const Vec3 up = rotation_from_degrees({0, 90, 0}) * Vec3(0, 0, -1);
    CHECK(up.y == test::near(1.0f));  // pitch looks up
    const Vec3 both = rotation_from_degrees({90, 30, 0}) * Vec3(0, 0, -1);
    CHECK(both.x == test::near(-std::cos(radians(30.0f))));
    CHECK(both.y == test::near(0.5f));
    const Vec3 rolled = rotation_from_degrees({0, 0, 90}) * Vec3(1, 0, 0);
    CHECK(rolled.y == test::near(1.0f));
    const auto transform = read<Transform>(R"({"rotation": [90, 30, 0]})");
    CHECK(glm::length(transform.rotation * Vec3(0, 0, -1) - both) < 1e-6f);
    const auto units = read<Transform>(R"({"rotation": ["90deg", "0.5235988rad", 0]})");
    CHECK(glm::length(units.rotation * Vec3(0, 0, -1) - both) < 1e-6f);
    CHECK(
        error_of<Transform>(R"({"rotation": ["1rad", 0, 0, 0]})").find("found the string")
        != std::string::npos);
}

TEST_CASE(
    "json: interpolated Euler angles depend on how poses are written, and lock at 90 degrees"
    * technique("anim.euler")) {
    const auto apart = [](const Quat& a, const Quat& b) {
        return std::min(glm::length(a - b), glm::length(a + b));
    };
    // One pose by two names, with two ways there; as quaternions there is one.
    const Quat pitched = rotation_from_degrees({0, 180, 0});
    const Quat twisted = rotation_from_degrees({180, 0, 180});
    CHECK(apart(pitched, twisted) < 1e-6f);
    const Quat half_pitched = rotation_from_degrees({0, 90, 0});
    const Quat half_twisted = rotation_from_degrees({90, 0, 90});
    CHECK(apart(half_pitched, half_twisted) > 0.5f);
    CHECK(half_pitched.w == test::near(0.70710678));
    CHECK(half_pitched.x == test::near(0.70710678));
    for (int i = 0; i < 4; ++i) {
        CHECK(std::abs(half_twisted[i]) == test::near(0.5));
    }
    CHECK(apart(slerp(Quat(1, 0, 0, 0), pitched, 0.5f), half_pitched) < 1e-6f);
    // Looking up, yaw and roll are one axis: of three angles two are left.
    const auto turn_of = [](Vec3 angles, int angle) {
        const Quat before = rotation_from_degrees(angles);
        angles[angle] += 1;
        return log_rotation(rotation_from_degrees(angles) * glm::conjugate(before));
    };
    const auto volume = [&](const Vec3& angles) {
        Mat3 turns;
        for (int angle = 0; angle < 3; ++angle) {
            turns[angle] = glm::normalize(turn_of(angles, angle));
        }
        return std::abs(glm::determinant(turns));
    };
    CHECK(volume({30, 0, 10}) > 0.9f);
    CHECK(volume({30, 90, 10}) < 0.02f);
}

TEST_CASE("component json: errors name the position, the expectation and the nearest name") {
    CHECK(error_of<Everything>(R"({"lable": "a"})")
              .starts_with(
                  "t.json:1:2: thing: found the field \"lable\", expected one of on small "));
    CHECK(error_of<Everything>(R"({"lable": "a"})").ends_with("(did you mean label?)"));
    CHECK(
        error_of<Everything>(R"({"on": 1})")
        == "t.json:1:8: thing.on: found the number 1, expected true or false");
    CHECK(
        error_of<Everything>("{\n \"knob\": {\"clicks\": 10}}")
        == "t.json:2:21: thing.knob.clicks: found the number 10, expected an integer 0 .. 9");
    CHECK(
        error_of<Everything>(R"({"knob": {"turn": -11}})")
        == "t.json:1:19: thing.knob.turn: found the number -11, expected a number -10 .. 10 rad "
           "(for degrees write \"-11deg\")");
    CHECK(
        error_of<Everything>(R"({"mood": "calmm"})")
        == "t.json:1:10: thing.mood: found the string \"calmm\", expected one of calm busy wild "
           "(did you mean calm?)");
    CHECK(
        error_of<Everything>(R"({"flat": [1, 2, 3]})")
        == "t.json:1:10: thing.flat: found an array of 3, expected an array of 2 numbers");
    CHECK(
        error_of<Everything>(R"({"flat": [1, "2"]})")
        == "t.json:1:14: thing.flat[1]: found the string \"2\", expected a number");
    CHECK(
        error_of<Everything>(R"({"triple": [1, 2]})")
        == "t.json:1:12: thing.triple: found an array of 2, expected an array of 3");
    CHECK(
        error_of<Everything>(R"({"mesh": "teapod"})")
        == "t.json:1:10: thing.mesh: found the mesh \"teapod\", expected an existing name "
           "(did you mean teapot?)");
    CHECK(error_of<Everything>(R"({"friend_of": "lmap"})").ends_with("(did you mean lamp?)"));
    CHECK(
        error_of<Everything>(R"({"friend_of": 3})").find("the name of an entity, or null")
        != std::string::npos);
    CHECK(
        error_of<Everything>(R"({"knobs": [{}, {"clicks": true}]})")
        == "t.json:1:27: thing.knobs[1].clicks: found true, expected an integer 0 .. 9");
    CHECK(
        error_of<Everything>(R"([])")
        == "t.json:1:1: thing: found an array of 0, expected an object with the fields to set");
}

TEST_CASE("component json: integers must be whole and fit their type") {
    for (const char* text :
         {"128", "-129", "1.5", "1e1", "\"1\"", "null", "99999999999999999999"}) {
        CAPTURE(text);
        CHECK_FALSE(error_of<Everything>(std::string(R"({"small": )") + text + "}").empty());
    }
    CHECK_FALSE(error_of<Everything>(R"({"large": -1})").empty());
    CHECK_FALSE(error_of<Everything>(R"({"large": 18446744073709551616})").empty());
    CHECK_FALSE(error_of<Everything>(R"({"far": 9223372036854775808})").empty());
    CHECK_FALSE(error_of<Everything>(R"({"cell": [1, 2, 2147483648]})").empty());
}

TEST_CASE("component json: numbers that become infinite as float are refused") {
    CHECK(error_of<Everything>(R"({"flat": [1e39, 0]})").find("32-bit") != std::string::npos);
    CHECK(read<Everything>(R"({"fine": 1e39})").fine == 1e39);
}

TEST_CASE("component json: the error for a color of 0 .. 255 says how to write it") {
    const std::string hint = "(for 0 .. 255 write \"#rrggbb\")";
    CHECK(error_of<Everything>(R"({"tint": [255, 128, 0]})").ends_with(hint));
    CHECK(error_of<Everything>(R"({"tint": [0, 0, 300]})").find(hint) == std::string::npos);
    CHECK(error_of<Everything>(R"({"tint": [-1, 0, 0]})").find(hint) == std::string::npos);
}

TEST_CASE("component json: invalid colors and angles are refused") {
    for (const char* text :
         {"\"ff8000\"", "\"#ff80\"", "\"#gg8000\"", "\"#ff800080\"", "\"\"", "\"#\""}) {
        CAPTURE(text);
        CHECK_FALSE(error_of<Everything>(std::string(R"({"tint": )") + text + "}").empty());
    }
    for (const char* text : {"\"deg\"", "\"90\"", "\"90 degrees\"", "\"nandeg\"", "\"infdeg\""}) {
        CAPTURE(text);
        CHECK_FALSE(error_of<Knob>(std::string(R"({"turn": )") + text + "}").empty());
    }
    CHECK_FALSE(error_of<Knob>(R"({"turn": "720deg"})").empty());  // more than 10 rad
    CHECK_FALSE(error_of<Everything>(R"({"turn": [0, 0, 0, 0]})").empty());
}

TEST_CASE("component json: a scale of 0 and a spot light turned inside out are refused") {
    CHECK(
        error_of<Transform>(R"({"scale": [1, 0, 1]})")
        == "t.json:1:1: thing: found a scale of 0, expected a nonzero scale along each axis");
    CHECK(
        error_of<SpotLight>(R"({"inner_angle": 0.6, "outer_angle": 0.5})").find("outer_angle")
        != std::string::npos);
}

TEST_CASE(
    "component json: what is written reads back the same, to the bit"
    * technique("engine.param-desc")) {
    Everything all;
    all.on = true;
    all.small = -100;
    all.large = 18446744073709551615u;
    all.far = std::numeric_limits<std::int64_t>::min();
    all.fine = 1.0 / 3.0;
    all.flat = {0.1f, -1e-40f};
    all.turn = glm::normalize(Quat(1, 2, 3, 4));
    all.label = "quote \" \n";
    all.mood = Mood::Busy;
    all.friend_of = {4, 2};
    all.mesh.index = 7;
    all.knobs = {{1.25f, 1}, {-0.1f, 2}};
    all.words = {"", "b"};
    NameProvider names;
    names.asset = [](std::string_view, std::uint32_t) { return "teapot"; };
    names.entity = [](Entity) { return "lamp"; };
    const std::string text = write_json(write_component(component_info<Everything>(), &all, names));
    CAPTURE(text);
    const auto back = read<Everything>(text);
    // Normalizing a unit quaternion again may move its last bit.
    CHECK(
        glm::length(
            Vec4(back.turn.x, back.turn.y, back.turn.z, back.turn.w)
            - Vec4(all.turn.x, all.turn.y, all.turn.z, all.turn.w))
        < 1e-6f);
    all.turn = back.turn;
    CHECK(same(component_info<Everything>(), &all, &back));
}

TEST_CASE("component json: rotations are written in degrees and turn as before, also straight up") {
    const FieldInfo& turn = *find_field(component_info<Everything>().fields, "turn");
    Random random(7, 0, 0, 0);
    const auto draw = [&] { return random.uniform(-1.0f, 1.0f); };
    const auto turns_alike = [&](const Quat& q) {
        const JsonValue json = write_field(turn, &q, {});
        REQUIRE(json.items.size() == 3);
        Quat back(1, 0, 0, 0);
        REQUIRE(read_field(json, turn, &back, {"t.json", ""}, {}).ok());
        for (const Vec3 axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
            CHECK(glm::length(q * axis - back * axis) < 1e-6f);
        }
    };
    for (int i = 0; i < 1000; ++i) {
        const Quat any(draw(), draw(), draw(), draw());
        turns_alike(glm::normalize(any));
    }
    for (const float pitch : {90.0f, -90.0f, 89.9999f, 89.99f}) {
        for (const float yaw : {0.0f, 40.0f, 170.0f, -120.0f}) {
            turns_alike(rotation_from_degrees({yaw, pitch, 25}));
        }
    }
    const Quat q = rotation_from_degrees({30, -20, 45});
    CHECK(write_json(write_field(turn, &q, {})) == "[30, -20, 45]");
}

TEST_CASE(
    "component json: the defaults of every registered component survive a round trip"
    * technique("engine.param-desc")) {
    register_all_components();
    for (const ComponentInfo* info : all_components()) {
        CAPTURE(info->name);
        if (info->ops.construct_default == nullptr) {
            continue;
        }
        const AnyComponent original(*info);
        const JsonValue json = write_component(*info, original.data(), {});
        const Result<JsonValue> again = parse_json(write_json(json), "t.json");
        REQUIRE(again.ok());
        const Result<AnyComponent> back = read_component(*again, *info, {"t.json", ""}, {});
        REQUIRE_MESSAGE(back.ok(), (back.ok() ? "" : back.error().message));
        CHECK(same(*info, original.data(), back->data()));
    }
}

TEST_CASE("component json: assets are found at any depth") {
    Material material;
    int images = 0;
    for_each_asset(
        component_info<Material>().fields, &material,
        [&](std::string_view kind, std::uint32_t& index) {
            CHECK(kind == "image");
            index = 3;
            ++images;
        });
    CHECK(images == 21);  // one in each texture slot
    CHECK(material.emission_texture.image.index == 3);
}

TEST_CASE("any component: copies own their values") {
    Everything all;
    all.label = "a long text that is not stored in place";
    AnyComponent a = AnyComponent::of(all);
    AnyComponent b = a;
    b.as<Everything>().label = "b";
    CHECK(a.as<Everything>().label == "a long text that is not stored in place");
    a = std::move(b);
    CHECK(a.as<Everything>().label == "b");
    CHECK(AnyComponent().is_empty());
    const AnyComponent tag(component_info<Teleport>());
    CHECK(tag.data() != nullptr);
}

TEST_CASE("component_json: old names of fields and enumerators are read, with one warning each") {
    std::vector<std::string> warnings = test::messages_of([] {
        CHECK(read<Renamed>(R"({"largeness": 2})").size == 2);
        CHECK(read<Renamed>(R"({"bigness": 3, "temper": "mad"})").size == 3);
        CHECK(read<Renamed>(R"({"temper": "mad"})").mood == Mood::Wild);
        CHECK(read<Renamed>(R"({"mood": "lazy"})").mood == Mood::Calm);
    });
    CHECK(
        warnings
        == std::vector<std::string>{
            "largeness is renamed to size; the next version rejects the old name",
            "bigness is renamed to size; the next version rejects the old name",
            "temper is renamed to mood; the next version rejects the old name",
            "mad is renamed to wild; the next version rejects the old name",
            "lazy is renamed to calm; the next version rejects the old name"});
}

TEST_CASE("component_json: numbers with units are converted to the unit of the field") {
    CHECK(read<Measures>(R"({"angle": "45deg"})").angle == test::near(0.78539816));
    CHECK(read<Measures>(R"({"angle": "-1rad"})").angle == -1.0f);
    CHECK(read<Measures>(R"({"turn": "30rpm"})").turn == test::near(3.14159265));
    CHECK(read<Measures>(R"({"length": "30cm"})").length == test::near(0.3));
    CHECK(read<Measures>(R"({"length": "2 m"})").length == 2.0f);
    CHECK(read<Measures>(R"({"place": [1, "1mm", "1km"]})").place == Vec3(1, 0.001f, 1000));
    CHECK(read<Measures>(R"({"speed": "36km/h"})").speed == test::near(10));
    CHECK(read<Measures>(R"({"time": "2min"})").time == 120.0f);
    for (const char* text :
         {R"({"length": "2deg"})", R"({"length": "m"})", R"({"length": "2"})",
          R"({"angle": "45 degrees"})", R"({"plain": "2m"})", R"({"length": "1e999m"})"}) {
        CAPTURE(text);
        CHECK(error_of<Measures>(text).find("found the string") != std::string::npos);
    }
}

TEST_CASE("component_json: the error for a number out of range has the range in the written unit") {
    const auto expected = [](const std::string& error) {
        return error.substr(std::min(error.find(", expected "), error.size()));
    };
    CHECK(
        expected(error_of<Measures>(R"({"angle": "500deg"})"))
        == ", expected a number -183.35 .. 183.35 deg");
    CHECK(
        expected(error_of<Measures>(R"({"angle": "4rad"})"))
        == ", expected a number -3.2 .. 3.2 rad");
    CHECK(
        expected(error_of<Measures>(R"({"length": "-3cm"})"))
        == ", expected a number 0 or more cm");
    const auto minutes = [&](const char* text) {
        const JsonValue json = json_of(std::string_view(text));
        const Result<double> number = expect_number(json, -60, 3600, {"t.json", "at"}, "s");
        return number ? "" : expected(number.error().message);
    };
    CHECK(minutes("59min").empty());
    CHECK(minutes("61min") == ", expected a number -1 .. 60 min");
    CHECK(minutes("-61000ms") == ", expected a number -60000 .. 3600000 ms");
}

TEST_CASE("component_json: the error for degrees instead of radians says how to write them") {
    const std::string error = error_of<Measures>(R"({"angle": 45})");
    CHECK(error.ends_with("(for degrees write \"45deg\")"));
    CHECK(error_of<Measures>(R"({"angle": 1000})").find("degrees") == std::string::npos);
    CHECK(error_of<Measures>(R"({"length": -45})").find("degrees") == std::string::npos);
}

}  // namespace limn::component_json_test
