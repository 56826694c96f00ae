// Restores snapshots that nobody wrote. The first byte of the input chooses: an odd one takes the
// rest as it is, behind a header that fits; an even one takes it as edits (place, place, value) of
// a good snapshot, since a fuzzer would not guess the layout numbers of its components. Whatever is
// restored is hashed, saved and lived in.

#include "ecs/base/hash.h"
#include "ecs/base/jobs.h"
#include "ecs/base/log.h"
#include "ecs/components/all.h"
#include "ecs/components/camera.h"
#include "ecs/components/light.h"
#include "ecs/components/name.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"

#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace {

using namespace limn;

struct Pocket {
    std::vector<std::string> texts;
    std::vector<Entity> entities;
    std::vector<PointLight> lights;
};
template <typename Visitor>
void visit_fields(Pocket& pocket, Visitor&& visit) {
    visit("texts", pocket.texts);
    visit("entities", pocket.entities);
    visit("lights", pocket.lights);
}

struct Pin {
    bool straight = true;
    int length = 3;
};
template <typename Visitor>
void visit_fields(Pin& pin, Visitor&& visit) {
    visit("straight", pin.straight);
    visit("length", pin.length);
}

constexpr std::size_t kHeaderSize = 32;

std::vector<std::byte> with_header(std::vector<std::byte> payload) {
    std::vector<std::byte> bytes(kHeaderSize + payload.size());
    const std::uint32_t version = 1;
    const std::uint64_t size = payload.size();
    const std::uint64_t checksum = hash_bytes(payload.data(), payload.size());
    std::memcpy(bytes.data(), "LIMNSNAP", 8);
    std::memcpy(bytes.data() + 8, &version, 4);
    std::memcpy(bytes.data() + 16, &size, 8);
    std::memcpy(bytes.data() + 24, &checksum, 8);
    if (!payload.empty()) {
        std::memcpy(bytes.data() + kHeaderSize, payload.data(), payload.size());
    }
    return bytes;
}

}  // namespace

template <>
struct limn::ComponentTraits<Pin> : DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};

namespace {

std::vector<std::byte> good_payload() {
    register_all_components();
    register_component<Pocket>();
    register_component<Pin>();
    World world;
    const Entity root = world.create(Transform{}, Name{"root"});
    const Entity child = world.create(Transform{}, Parent{root}, PointLight{});
    world.create(Pocket{{"a", ""}, {root, child}, {PointLight{}}}, Teleport{});
    world.destroy(world.create(OrbitCamera{}));
    world.add(child, Pin{});
    world.insert_resource(FrameTime{});
    const std::vector<std::byte> bytes = save_snapshot(world).value();
    return {bytes.begin() + kHeaderSize, bytes.end()};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::vector<std::byte> good = good_payload();
    set_thread_count(1);
    set_log_level(LogLevel::Error);
    if (size == 0) {
        return 0;
    }
    std::vector<std::byte> payload;
    if (data[0] % 2 == 1) {
        payload.assign(
            reinterpret_cast<const std::byte*>(data + 1),
            reinterpret_cast<const std::byte*>(data + size));
    } else {
        payload = good;
        for (std::size_t i = 1; i + 3 <= size; i += 3) {
            payload[(data[i] * 256u + data[i + 1]) % payload.size()] = std::byte{data[i + 2]};
        }
        if (data[0] >= 128) {
            payload.resize(payload.size() * (data[0] - 128) / 128);
        }
    }

    World world;
    const Entity before = world.create(Name{"before"}, Transform{});
    if (!restore_snapshot(world, with_header(payload))) {
        if (!world.alive(before) || world.entity_count() != 1) {
            std::abort();  // a refused snapshot changed the world
        }
        return 0;
    }
    const std::uint64_t hash = state_hash(world);
    const Result<std::vector<std::byte>> saved = save_snapshot(world);
    World copy;
    if (!saved || !restore_snapshot(copy, *saved) || state_hash(copy) != hash) {
        std::abort();
    }
    static_cast<void>(hierarchy(world));
    std::vector<Entity> all;
    world.each_entity([&](Entity entity) { all.push_back(entity); });
    for (const Entity entity : all) {
        static_cast<void>(depth_of(world, entity));
        world.add(entity, Spin{});
    }
    for (const Entity entity : all) {
        world.destroy(entity);
    }
    return 0;
}
