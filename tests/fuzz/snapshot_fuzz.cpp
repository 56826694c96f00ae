// Restores snapshots and applies deltas that nobody wrote. The first byte of the input chooses:
//
//     0  a snapshot that is the rest of the input, behind a header that fits
//     1  a good snapshot with the rest as edits: what (1 byte), place (2), value (1)
//     2  the same with a good delta
//
// since a fuzzer would not guess the layout numbers of components. Checksums are made to fit, so
// that the parser behind them is reached. Whatever is restored is hashed, saved and lived in; and
// nothing may allocate more than the size of the input allows.

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
#include "tests/ecs/allocation_count.h"
#include "tests/ecs/snapshot_seal.h"
#include "tests/ecs/snapshot_story.h"

#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace {

using namespace limn;
using namespace snapshot_story;

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

using Bytes = std::vector<std::byte>;

/// A snapshot with something of everything, and a delta to what came after it.
struct Good {
    Bytes snapshot;
    Bytes delta;

    Good() {
        register_all_components();
        register_component<Pocket>();
        Story story(1);
        World& world = story.world;
        const Entity root = world.create(Transform{}, Name{"root"});
        const Entity child = world.create(Transform{}, Parent{root}, PointLight{});
        const Entity other = world.create(StorySpin{}, StoryLamp{}, StoryAwake{}, StoryLife{});
        world.create(Pocket{{"a", ""}, {root, child}, {PointLight{}}}, Teleport{});
        world.destroy(world.create(OrbitCamera{}));
        world.create(StoryRoute{{1, 2}, {{root, 30, false}}});
        world.create(StoryShade{1, root});
        world.create(StoryShade{2, root});
        world.disable<StoryLamp>(other);
        world.add(child, StoryHeat{});
        world.add(child, StoryNote{"note"});
        world.add(other, StoryPicked{});
        world.insert_resource(FrameTime{});
        world.insert_resource(StoryTitle{"title"});
        SnapshotMark mark;
        snapshot = save(world, &mark);
        world.create(StoryText{"text"});
        world.get<Transform>(root).position.x = 1;
        delta = save_delta(world, mark).value();
    }
};

void require(bool condition) {
    if (!condition) {
        std::abort();
    }
}

void edit(Bytes& bytes, const std::uint8_t* edits, std::size_t size) {
    for (std::size_t i = 0; i + 4 <= size && !bytes.empty(); i += 4) {
        const std::size_t place = (edits[i + 1] * 256u + edits[i + 2]) % bytes.size();
        const std::uint8_t value = edits[i + 3];
        const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(place);
        switch (edits[i] % 5) {
        case 0:
            *at = std::byte{value};
            break;
        case 1:
            *at ^= static_cast<std::byte>(1u << value % 8);
            break;
        case 2:  // a large number
            std::memset(&*at, value, std::min<std::size_t>(4, bytes.size() - place));
            break;
        case 3:
            bytes.erase(at, at + std::min<std::ptrdiff_t>(value, bytes.end() - at));
            break;
        default:
            bytes.insert(at, value, std::byte{value});
            break;
        }
    }
}

Bytes with_header(const std::uint8_t* data, std::size_t size) {
    SnapshotHeader header;
    if (size >= 3) {
        header.head_size = data[0] * 256u + data[1];
        header.piece_count = data[2];
    }
    ByteWriter out;
    write_header(header, out);
    out.bytes(data, size);
    return out.take();
}

void live_in(World& world) {
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
}

void try_restore(const Bytes& bytes) {
    World world;
    const Entity before = world.create(Name{"before"}, Transform{});
    bool restored = false;
    SnapshotMark mark;
    const std::size_t allocated =
        test::bytes_allocated_by([&] { restored = restore_snapshot(world, bytes, &mark).ok(); });
    require(allocated <= 200 * bytes.size() + (512 << 10));
    if (!restored) {
        require(world.alive(before) && world.entity_count() == 1);
        return;
    }
    const std::uint64_t hash = state_hash(world);
    const Result<Bytes> saved = save_snapshot(world);
    const Result<Bytes> delta = save_delta(world, mark);
    require(saved.ok() && delta.ok());
    const Result<Bytes> applied = apply_delta(bytes, *delta);
    require(applied.ok() && *applied == *saved);
    World copy;
    require(restore_snapshot(copy, *saved).ok() && state_hash(copy) == hash);
    require(save_snapshot(copy).value() == *saved);
    live_in(world);
}

void try_apply(const Bytes& base, const Bytes& delta) {
    Bytes later;
    const std::size_t allocated = test::bytes_allocated_by([&] {
        if (Result<Bytes> applied = apply_delta(base, delta); applied) {
            later = std::move(*applied);
        }
    });
    require(allocated <= 4 * (base.size() + delta.size()) + (64 << 10));
    if (!later.empty()) {
        try_restore(later);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Good good;
    set_thread_count(1);
    set_log_level(LogLevel::Error);
    if (size == 0) {
        return 0;
    }
    Bytes bytes;
    switch (data[0] % 3) {
    case 0:
        bytes = with_header(data + 1, size - 1);
        test::seal_snapshot(bytes);
        try_restore(bytes);
        break;
    case 1:
        bytes = good.snapshot;
        edit(bytes, data + 1, size - 1);
        test::seal_snapshot(bytes);
        try_restore(bytes);
        break;
    default:
        bytes = good.delta;
        edit(bytes, data + 1, size - 1);
        test::seal_delta(bytes);
        try_apply(good.snapshot, bytes);
        break;
    }
    return 0;
}
