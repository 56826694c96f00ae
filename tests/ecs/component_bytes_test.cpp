#include "ecs/component_bytes.h"
#include "ecs/components/light.h"
#include "ecs/components/transform.h"

#include <doctest/doctest.h>

#include <cstring>
#include <memory>

namespace component_bytes_test {

using namespace limn;

enum class Side : std::uint8_t { Left, Right };

struct Stop {
    std::string name;
    std::vector<float> times;
    Entity who;
};

struct Route {
    bool open = true;
    Side side = Side::Left;
    double length = 1.0;
    std::vector<Stop> stops;
    Entity pair[2];
    std::string text;
};

template <typename Visitor>
void visit_fields(Stop& stop, Visitor&& visit) {
    visit("name", stop.name);
    visit("times", stop.times);
    visit("who", stop.who);
}
template <typename Visitor>
void visit_fields(Route& route, Visitor&& visit) {
    visit("open", route.open);
    visit("side", route.side, {.values = "left right"});
    visit("length", route.length);
    visit("stops", route.stops);
    visit("pair", route.pair);
    visit("text", route.text);
}

Route sample() {
    Route route;
    route.length = 2.5;
    route.side = Side::Right;
    route.stops = {
        {"a", {1, 2, 3}, {1, 2}},
        {"", {}, {}},
        {"longer than a small string would be", {4}, {3, 4}}};
    route.pair[1] = {5, 6};
    route.text = "x";
    return route;
}

template <typename T>
std::vector<std::byte> bytes_of(const T& value, std::size_t count = 1) {
    ByteWriter out;
    write_values(component_info<T>(), &value, count, out);
    return out.take();
}

}  // namespace component_bytes_test

using namespace limn;
using namespace component_bytes_test;

TEST_CASE("component bytes: what is written is read back") {
    const Route route = sample();
    const std::vector<std::byte> bytes = bytes_of(route);
    Route read;
    ByteReader in(bytes);
    REQUIRE(read_values(component_info<Route>(), &read, 1, in));
    CHECK(in.left() == 0);
    CHECK(bytes_of(read) == bytes);
    CHECK(read.stops.size() == 3);
    CHECK(read.stops[2].name == route.stops[2].name);
    CHECK(read.stops[0].times == route.stops[0].times);
    CHECK(read.stops[2].who == Entity{3, 4});
    CHECK(read.side == Side::Right);

    const PointLight lights[3] = {
        {.intensity = 1}, {.intensity = 2, .enabled = false}, {.radius = 3}};
    const std::vector<std::byte> light_bytes = bytes_of(lights[0], 3);
    CHECK(light_bytes.size() == 3 * min_serialized_size(component_info<PointLight>()));
    PointLight read_lights[3];
    ByteReader light_in(light_bytes);
    REQUIRE(read_values(component_info<PointLight>(), read_lights, 3, light_in));
    CHECK(read_lights[1].intensity == 2);
    CHECK_FALSE(read_lights[1].enabled);
    CHECK(read_lights[2].radius == 3);
}

TEST_CASE("component bytes: padding makes no difference") {
    alignas(PointLight) unsigned char a[sizeof(PointLight)];
    alignas(PointLight) unsigned char b[sizeof(PointLight)];
    std::memset(a, 0x00, sizeof a);
    std::memset(b, 0xff, sizeof b);
    auto* light_a = new (a) PointLight;
    auto* light_b = new (b) PointLight;
    std::memset(a + 41, 0x11, 3);  // after the last bool
    std::memset(b + 41, 0x22, 3);
    CHECK(bytes_of(*light_a) == bytes_of(*light_b));
    const ComponentInfo& info = component_info<PointLight>();
    CHECK(hash_values(info, light_a, 1, 0) == hash_values(info, light_b, 1, 0));
    light_b->attenuation.linear = 0.001f;
    CHECK(hash_values(info, light_a, 1, 0) != hash_values(info, light_b, 1, 0));
}

TEST_CASE("component bytes: every field counts in the hash") {
    const ComponentInfo& info = component_info<Route>();
    const Route route = sample();
    const std::uint64_t before = hash_values(info, &route, 1, 0);
    const auto differs = [&](auto change) {
        Route other = sample();
        change(other);
        return hash_values(info, &other, 1, 0) != before;
    };
    CHECK_FALSE(differs([](Route&) {}));
    CHECK(differs([](Route& r) { r.open = false; }));
    CHECK(differs([](Route& r) { r.side = Side::Left; }));
    CHECK(differs([](Route& r) { r.stops.pop_back(); }));
    CHECK(differs([](Route& r) { r.stops[0].times[2] = 4; }));
    CHECK(differs([](Route& r) { r.stops[1].name = "b"; }));
    CHECK(differs([](Route& r) { r.pair[1].generation = 7; }));
    CHECK(differs([](Route& r) { r.text = "y"; }));
}

TEST_CASE("component bytes: truncated bytes are rejected at every length") {
    const std::vector<std::byte> bytes = bytes_of(sample());
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        Route read;
        ByteReader in(std::span<const std::byte>(bytes).first(length));
        CHECK_FALSE(read_values(component_info<Route>(), &read, 1, in));
    }
}

TEST_CASE("component bytes: invalid bools, enumerators and counts are rejected") {
    std::vector<std::byte> bytes = bytes_of(sample());
    Route read;
    const auto refused = [&] {
        ByteReader in(bytes);
        return !read_values(component_info<Route>(), &read, 1, in);
    };
    bytes[0] = std::byte{2};  // open
    CHECK(refused());
    bytes[0] = std::byte{1};
    CHECK_FALSE(refused());
    bytes[1] = std::byte{2};  // side
    CHECK(refused());
    bytes[1] = std::byte{1};
    const std::uint32_t many = 0x7fffffff;
    std::memcpy(bytes.data() + 10, &many, 4);  // how many stops
    CHECK(refused());
}

TEST_CASE("component bytes: all entities of a component are found") {
    Route route = sample();
    std::vector<Entity> found;
    for_each_entity(
        component_info<Route>().fields, &route, [&](Entity& entity) { found.push_back(entity); });
    CHECK(found == std::vector<Entity>{{1, 2}, {}, {3, 4}, {}, {5, 6}});
}

TEST_CASE("component bytes: the layout hash distinguishes types with different fields") {
    CHECK(layout_hash(component_info<PointLight>()) == layout_hash(component_info<PointLight>()));
    CHECK(layout_hash(component_info<PointLight>()) != layout_hash(component_info<SpotLight>()));
    CHECK(layout_hash(component_info<Spin>()) != layout_hash(component_info<Sway>()));
    CHECK(layout_hash(component_info<Teleport>()) != layout_hash(component_info<Transform>()));
}
