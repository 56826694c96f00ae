#include "ecs/components/all.h"
#include "ecs/components/light.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/field_access.h"
#include "ecs/reflect.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>

namespace reflect_test {

using namespace limn;

enum class Mood : std::uint8_t { Calm, Merry, Grim };

struct Key {
    float time = 0.0f;
    Vec3 point = {0, 0, 0};
};

struct AllKinds {
    bool flag = true;
    std::int8_t small = -3;
    std::uint64_t large = 7;
    double exact = 0.5;
    Quat turn = {1, 0, 0, 0};
    IVec2 cell = {1, 2};
    Mat3 matrix = Mat3(1.0f);
    Affine affine;
    std::string text = "hi";
    Mood mood = Mood::Merry;
    Entity friend_of;
    MeshId mesh;
    Key key;
    Vec2 corners[4] = {};
    std::array<int, 3> numbers = {1, 2, 3};
    std::vector<Key> path = {{0.0f, {1, 2, 3}}, {1.0f, {4, 5, 6}}};
};

template <typename Visitor>
void visit_fields(Key& key, Visitor&& visit) {
    visit("time", key.time, {.unit = "s", .min = 0});
    visit("point", key.point);
}

template <typename Visitor>
void visit_fields(AllKinds& all, Visitor&& visit) {
    visit("flag", all.flag);
    visit("small", all.small, {.min = -10, .max = 10});
    visit("large", all.large);
    visit("exact", all.exact);
    visit("turn", all.turn);
    visit("cell", all.cell);
    visit("matrix", all.matrix);
    visit("affine", all.affine);
    visit("text", all.text, {.doc = "what it says"});
    visit("mood", all.mood, {.values = "calm merry grim"});
    visit("friend_of", all.friend_of);
    visit("mesh", all.mesh);
    visit("key", all.key);
    visit("corners", all.corners);
    visit("numbers", all.numbers);
    visit("path", all.path);
}

struct HTTPServer2Tag {};
struct Padded {
    char a = 0;
    float b = 0;
};
struct Tight {
    float a = 0;
    std::uint32_t b = 0;
    bool c[4] = {};
};
struct Holder {
    std::vector<float> values;
};
struct MoveOnly {
    std::unique_ptr<int> value;
};
struct Unsaved {
    int value = 0;
};
/// Counts its living instances.
struct Counted {
    static inline int alive = 0;
    int value = 5;
    Counted() { ++alive; }
    Counted(const Counted& other) : value(other.value) { ++alive; }
    Counted(Counted&& other) noexcept : value(other.value) { ++alive; }
    ~Counted() { --alive; }
};

const FieldInfo& field(const char* name) {
    const FieldInfo* const found = find_field(component_info<AllKinds>().fields, name);
    REQUIRE(found != nullptr);
    return *found;
}

}  // namespace reflect_test

template <>
struct limn::ComponentTraits<reflect_test::Unsaved> : DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
    static constexpr bool saved = false;
};

using namespace limn;
using namespace reflect_test;

TEST_CASE("reflect: names come from types in snake case") {
    CHECK(component_info<PointLight>().name == "point_light");
    CHECK(component_info<HTTPServer2Tag>().name == "http_server2_tag");
    CHECK(snake_case("A") == "a");
    CHECK(snake_case("WorldTransform") == "world_transform");
    CHECK(snake_case("Level2Part") == "level2_part");
    CHECK(snake_case("Pair<int, float>") == "pair_int_float");
    CHECK(short_name("limn::(anonymous namespace)::Thing") == "Thing");
    CHECK(short_name(value_name<register_all_components>()) == "register_all_components");
    CHECK(type_name<PointLight>() == "limn::PointLight");
}

TEST_CASE("reflect: ids are dense, different for different types and the same on every use") {
    CHECK(component_id<PointLight> != component_id<SpotLight>);
    CHECK(component_info(component_id<PointLight>).id == component_id<PointLight>);
    CHECK(&component_info<const PointLight&>() == &component_info<PointLight>());
    for (ComponentId id = 0; id < component_count(); ++id) {
        CHECK(component_info(id).id == id);
    }
}

TEST_CASE(
    "reflect: only registered types have a name, and similar names are suggested"
    * technique("engine.type-registry")) {
    register_all_components();
    register_all_components();
    CHECK(find_component("point_light") == &component_info<PointLight>());
    CHECK(find_component("PointLight") == nullptr);
    CHECK(find_component("exposure") == nullptr);
    CHECK(find_resource("exposure") != nullptr);
    CHECK(find_component("padded") == nullptr);
    CHECK(component_suggestion("pont_light") == " (did you mean point_light?)");
    CHECK(component_suggestion("transfrom") == " (did you mean transform?)");
    CHECK(component_suggestion("quite_another_thing") == "");
    CHECK(resource_suggestion("enviroment") == " (did you mean environment?)");

    const std::vector<const ComponentInfo*> all = all_components();
    for (std::size_t i = 1; i < all.size(); ++i) {
        CHECK(all[i - 1]->name < all[i]->name);
    }
}

TEST_CASE(
    "reflect: every field of every registered component has a description and a default in "
    "its range"
    * technique("engine.param-desc")) {
    register_all_components();
    std::vector<const ComponentInfo*> all = all_components();
    const std::vector<const ComponentInfo*> resources = all_resources();
    all.insert(all.end(), resources.begin(), resources.end());
    for (const ComponentInfo* info : all) {
        CAPTURE(info->name);
        // Otherwise snapshots and hashes would miss it.
        CHECK(info->value_bytes != ValueBytes::Opaque);
        for (const FieldInfo& field : info->fields) {
            CAPTURE(field.name);
            CHECK(*field.meta.doc != '\0');
            CHECK(field.meta.min < field.meta.max);
            CHECK((field.type != FieldType::Enum || !field.values.empty()));
        }
        if (info->defaults != nullptr) {
            const Status status = validate_fields(*info, info->defaults);
            CHECK_MESSAGE(status.ok(), (status ? "" : status.error().message));
        }
    }
}

TEST_CASE("reflect: every type that a component header describes is registered, or part of a "
          "registered one") {
    register_all_components();
    std::string headers;
    for (const auto& entry :
         std::filesystem::directory_iterator(LIMN_SOURCE_DIR "/ecs/components")) {
        std::ifstream header(entry.path());
        headers.append(std::istreambuf_iterator<char>(header), {});
    }
    // Of another, of an asset, or of the recipe of one.
    const auto is_part = [&](const std::string& type) {
        return type == "PathShape" || type == "FurrowStyle" || type == "FurrowArrow"
               || headers.find("<" + type + ">") != std::string::npos
               || headers.find("<" + type + ",") != std::string::npos  // std::array
               || headers.find("\n    " + type + " ") != std::string::npos;
    };
    int described = 0;
    const std::string key = "LIMN_FIELDS(";
    for (std::size_t at = headers.find(key); at != std::string::npos;
         at = headers.find(key, at + 1)) {
        const std::size_t begin = at + key.size();
        const std::string type = headers.substr(begin, headers.find(')', begin) - begin);
        const std::string name = snake_case(type);
        CAPTURE(name);
        CHECK((find_component(name) != nullptr || find_resource(name) != nullptr || is_part(type)));
        ++described;
    }
    CHECK(described > 15);
}

TEST_CASE("reflect: fields have type, offset and shape" * technique("engine.param-desc")) {
    const AllKinds instance;
    const auto offset_of = [&](const auto& member) {
        return static_cast<std::uint32_t>(
            reinterpret_cast<const char*>(&member) - reinterpret_cast<const char*>(&instance));
    };
    CHECK(component_info<AllKinds>().fields.size() == 16);
    CHECK(field("flag").type == FieldType::Bool);
    CHECK(field("small").type == FieldType::Int);
    CHECK(field("small").size == 1);
    CHECK(field("large").type == FieldType::UInt);
    CHECK(field("large").offset == offset_of(instance.large));
    CHECK(field("exact").type == FieldType::Double);
    CHECK(field("turn").type == FieldType::Quat);
    CHECK(field("cell").type == FieldType::IVec2);
    CHECK(field("matrix").type == FieldType::Mat3);
    CHECK(field("affine").type == FieldType::Affine);
    CHECK(field("text").type == FieldType::String);
    CHECK(std::string(field("text").meta.doc) == "what it says");
    CHECK(field("mood").type == FieldType::Enum);
    CHECK(field("mood").values == std::vector<std::string_view>{"calm", "merry", "grim"});
    CHECK(field("friend_of").type == FieldType::Entity);
    CHECK(field("mesh").type == FieldType::Asset);
    CHECK(std::string(field("mesh").asset) == "mesh");
    CHECK(field("key").type == FieldType::Struct);
    CHECK(field("key").fields.size() == 2);
    CHECK(field("corners").shape == FieldShape::Array);
    CHECK(field("corners").count == 4);
    CHECK(field("numbers").count == 3);
    CHECK(field("path").shape == FieldShape::List);
    CHECK(field("path").type == FieldType::Struct);
    CHECK(field("path").size == sizeof(Key));
    CHECK(field("path").offset == offset_of(instance.path));
    CHECK(component_info<AllKinds>().has_entities);
    CHECK_FALSE(component_info<PointLight>().has_entities);
}

TEST_CASE("reflect: a type describes how it is stored, moved and compared") {
    CHECK(component_info<HTTPServer2Tag>().is_tag);
    CHECK(component_info<HTTPServer2Tag>().size == 0);
    CHECK(component_info<Transform>().value_bytes == ValueBytes::All);
    CHECK(component_info<WorldTransform>().value_bytes == ValueBytes::All);
    CHECK(component_info<Tight>().value_bytes == ValueBytes::All);
    CHECK(component_info<Padded>().value_bytes == ValueBytes::Opaque);
    CHECK(component_info<PointLight>().value_bytes == ValueBytes::Fields);
    CHECK(component_info<Holder>().value_bytes == ValueBytes::Opaque);
    CHECK_FALSE(static_cast<bool>(component_info<MoveOnly>().ops.construct_copy));
    CHECK_FALSE(component_info<MoveOnly>().trivially_relocatable);
    CHECK(component_info<Unsaved>().storage == Storage::Sparse);
    CHECK_FALSE(component_info<Unsaved>().saved);
    CHECK(component_info<Unsaved>().hashed);
    CHECK(component_info<Transform>().saved);
}

TEST_CASE("reflect: ops construct, copy, move and destroy as often as they say") {
    const ComponentOps& ops = component_info<Counted>().ops;
    CHECK(Counted::alive == 0);
    alignas(Counted) std::byte a[3 * sizeof(Counted)];
    alignas(Counted) std::byte b[3 * sizeof(Counted)];
    ops.construct_default(a, 3);
    CHECK(Counted::alive == 3);
    reinterpret_cast<Counted*>(a)[2].value = 9;
    ops.construct_copy(b, a, 3);
    CHECK(Counted::alive == 6);
    CHECK(reinterpret_cast<Counted*>(b)[2].value == 9);
    ops.destroy(b, 3);
    ops.relocate(b, a, 3);
    CHECK(Counted::alive == 3);
    CHECK(reinterpret_cast<Counted*>(b)[0].value == 5);
    ops.destroy(b, 3);
    CHECK(Counted::alive == 0);
}

TEST_CASE("reflect: numbers are read and written, and rejected outside their range or type") {
    AllKinds all;
    CHECK(get_number(field("small"), &all.small) == -3);
    CHECK(set_number(field("small"), &all.small, -10).ok());
    CHECK(all.small == -10);
    CHECK(
        set_number(field("small"), &all.small, 11).error().message
        == "found 11, expected -10 .. 10");
    CHECK(
        set_number(field("small"), &all.small, 1.5).error().message
        == "found 1.5, expected -10 .. 10");
    CHECK(all.small == -10);
    CHECK_FALSE(set_number(field("large"), &all.large, -1).ok());
    CHECK(set_number(field("large"), &all.large, 4294967297.0).ok());
    CHECK(all.large == 4294967297u);
    CHECK_FALSE(set_number(field("large"), &all.large, 1e300).ok());
    CHECK(set_number(field("exact"), &all.exact, 1e300).ok());
    CHECK_FALSE(
        set_number(field("exact"), &all.exact, std::numeric_limits<double>::quiet_NaN()).ok());
    CHECK_FALSE(set_number(field("turn"), &all.turn, 1e300, 2).ok());  // no such float

    const double turn[] = {0.5, -0.5, 0.25, 1};
    CHECK(set_numbers(field("turn"), &all.turn, turn).ok());
    CHECK(all.turn == Quat(1, 0.5f, -0.5f, 0.25f));
    CHECK(get_number(field("turn"), &all.turn, 3) == 1);
    CHECK(
        set_numbers(field("turn"), &all.turn, std::span(turn).first(3)).error().message
        == "found 3 numbers, expected 4");
    const double bad[] = {3, 0.5};
    CHECK_FALSE(set_numbers(field("cell"), &all.cell, bad).ok());
    CHECK(all.cell == IVec2(1, 2));  // all or nothing
}

TEST_CASE("reflect: a limit that a float cannot hold exactly is still a valid value") {
    PointLight light;
    FieldInfo info = component_info<PointLight>().fields[1];
    info.meta.max = 0.1;
    CHECK(set_number(info, &light.intensity, 0.1).ok());
    CHECK_FALSE(set_number(info, &light.intensity, 0.1001).ok());
}

TEST_CASE("reflect: enumerators are written by name") {
    AllKinds all;
    CHECK(get_enum(field("mood"), &all.mood) == "merry");
    CHECK(set_enum(field("mood"), &all.mood, "grim").ok());
    CHECK(all.mood == Mood::Grim);
    CHECK(
        set_enum(field("mood"), &all.mood, "grym").error().message
        == "found \"grym\", expected one of calm merry grim (did you mean grim?)");
}

TEST_CASE(
    "reflect: a path leads through structs, arrays and lists" * technique("engine.param-access")) {
    AllKinds all;
    const ComponentInfo& info = component_info<AllKinds>();
    CHECK(field_at(info, &all, "flag").value().element == &all.flag);
    CHECK(field_at(info, &all, "key.point").value().element == &all.key.point);
    CHECK(field_at(info, &all, "corners.2").value().element == &all.corners[2]);
    CHECK(field_at(info, &all, "path.1.time").value().element == &all.path[1].time);
    CHECK(
        field_at(info, &all, "path.2.time").error().message
        == "all_kinds: path: found index \"2\", expected less than 2");
    CHECK(
        field_at(info, &all, "key.pont").error().message
        == "all_kinds: no field \"pont\" (did you mean point?)");
    CHECK_FALSE(field_at(info, &all, "").ok());
    CHECK_FALSE(field_at(info, &all, "flag.x").ok());
    CHECK_FALSE(field_at(info, &all, "path.-1.time").ok());
    CHECK_FALSE(field_at(info, &all, "path.1x.time").ok());
    all.path.clear();
    CHECK(field_at(info, &all, "path").value().element == nullptr);
    CHECK_FALSE(field_at(info, &all, "path.time").ok());
}

TEST_CASE("reflect: validation finds what is out of range at any depth") {
    AllKinds all;
    const ComponentInfo& info = component_info<AllKinds>();
    CHECK(validate_fields(info, &all).ok());
    all.path[1].time = -1;
    CHECK(
        validate_fields(info, &all).error().message == "path.time: found -1, expected 0 or more s");
    all = {};
    all.key.point.y = std::numeric_limits<float>::infinity();
    CHECK(validate_fields(info, &all).error().message == "key.point: found inf, expected a number");
    all = {};
    const std::uint8_t nine = 9;
    std::memcpy(&all.mood, &nine, 1);
    CHECK(
        validate_fields(info, &all).error().message
        == "mood: found 9, expected one of calm merry grim");
    all = {};
    std::memcpy(&all.flag, &nine, 1);
    CHECK(validate_fields(info, &all).error().message == "flag: found 9, expected true or false");
}

TEST_CASE("reflect: values and types read well") {
    const AllKinds all;
    CHECK(value_text(field("turn"), &all.turn) == "[0, 0, 0, 1]");
    CHECK(value_text(field("mood"), &all.mood) == "merry");
    CHECK(value_text(field("text"), &all.text) == "\"hi\"");
    CHECK(value_text(field("friend_of"), &all.friend_of) == "none");
    CHECK(value_text(field("key"), &all.key) == "{time: 0, point: [0, 0, 0]}");
    CHECK(type_text(field("turn")) == "4 numbers");
    CHECK(type_text(field("mood")) == "one of calm merry grim");
    CHECK(type_text(field("path")) == "list of object");
    CHECK(type_text(field("mesh")) == "name of a mesh");
    CHECK(range_text(field("small").meta) == "-10 .. 10");
    CHECK(range_text({.min = 0, .max = 0.1f}) == "0 .. 0.1");
    const PointLight light{.intensity = 0.1f};
    CHECK(value_text(component_info<PointLight>().fields[1], &light.intensity) == "0.1");
}

TEST_CASE("reflect: equal elements are found equal, different ones different, at any depth") {
    AllKinds a;
    AllKinds b;
    CHECK(equal_elements(field("key"), &a.key, &b.key));
    b.key.point.z = 1;
    CHECK_FALSE(equal_elements(field("key"), &a.key, &b.key));
    CHECK(equal_elements(field("text"), &a.text, &b.text));
    b.text = "ho";
    CHECK_FALSE(equal_elements(field("text"), &a.text, &b.text));
}

TEST_CASE("reflect: edit distance counts typing errors") {
    CHECK(edit_distance("", "") == 0);
    CHECK(edit_distance("abc", "") == 3);
    CHECK(edit_distance("kitten", "sitting") == 3);
    CHECK(edit_distance("light", "lihgt") == 1);
    CHECK(nearest_name("raduis", std::vector<std::string>{"radius", "range"}) == "radius");
    CHECK(nearest_name("zzz", std::vector<std::string>{"radius", "range"}).empty());
}
