// The prefabs of content/effects: each can be placed by itself, and what is shot once leaves
// nothing.

#include "content/app/commands/stage.h"
#include "content/load/files/json_document.h"
#include "content/load/made_assets.h"
#include "ecs/base/log.h"
#include "ecs/components/beam.h"
#include "ecs/components/particles.h"
#include "ecs/components/transform.h"
#include "ecs/snapshot.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace limn::effects_test {
namespace {

struct EffectFile {
    std::string name;
    std::vector<std::string> prefabs;
};

std::vector<EffectFile> effect_files() {
    std::vector<EffectFile> files;
    const std::string folder = std::string(LIMN_SOURCE_DIR) + "/content/effects";
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (!name.ends_with(".effect.json")) {
            continue;
        }
        const Result<JsonValue> json = load_json(entry.path().string());
        REQUIRE_MESSAGE(json.ok(), (json.ok() ? "" : json.error().message));
        CHECK(json->find("title") != nullptr);
        const JsonValue* const prefabs = json->find("prefabs");
        if (prefabs == nullptr) {
            continue;  // only materials and meshes
        }
        EffectFile& file = files.emplace_back(EffectFile{name, {}});
        for (const JsonMember& member : prefabs->members) {
            file.prefabs.push_back(member.key);
        }
    }
    std::sort(files.begin(), files.end(), [](const EffectFile& a, const EffectFile& b) {
        return a.name < b.name;
    });
    return files;
}

std::unique_ptr<Stage>
open_text(const test::TemporaryFolder& folder, const std::string& text, MadeAssets& made) {
    const std::string path = folder.path() + "/t.level.json";
    std::ofstream(path) << text;
    Result<std::unique_ptr<Stage>> stage = open_stage(path, {.made = &made});
    REQUIRE_MESSAGE(stage.ok(), (stage ? std::string() : stage.error().message));
    return *std::move(stage);
}

constexpr const char* kCamera =
    R"({"name": "eye", "camera": {}, "transform": {"position": [0, 1.5, 6]}})";

}  // namespace

TEST_CASE("effects: every prefab works by itself, and makes particles or beams within a second") {
    const std::vector<EffectFile> files = effect_files();
    CHECK(files.size() >= 9);
    const test::TemporaryFolder folder;
    MadeAssets made;
    for (const EffectFile& file : files) {
        for (const std::string& prefab : file.prefabs) {
            CAPTURE(prefab);
            const std::uint64_t errors_before = logged_error_count();
            const std::unique_ptr<Stage> stage = open_text(
                folder,
                fmt::format(
                    R"({{"title": "t", "include": ["{}"], "entities": [{}, {{"prefab": "{}"}}]}})",
                    file.name, kCamera, prefab),
                made);
            advance_stage(*stage, 0.2);
            std::uint64_t born = 0;
            stage->world.query<const BeamState>().each(
                [&](const BeamState& beam) { born += beam.shown ? 1 : 0; });
            for (int i = 0; i < 60; ++i) {
                step_stage(*stage);
            }
            CHECK(logged_error_count() == errors_before);
            std::uint64_t dropped = 0;
            stage->world.query<const ParticlePool>().each([&](const ParticlePool& pool) {
                born += pool.clock.born;
                dropped += pool.clock.dropped;
            });
            CHECK(born > 0);
            CHECK(dropped == 0);
        }
    }
}

TEST_CASE(
    "explosion: each releases its children at its position, and none remains at the end"
    * technique("engine.explosion")) {
    const test::TemporaryFolder folder;
    MadeAssets made;
    const std::unique_ptr<Stage> stage = open_text(
        folder,
        fmt::format(
            R"({{"title": "t", "include": ["explosion.effect.json"], "entities": [{}], "events": [
                {{"at": 0.5, "spawn": [{{"prefab": "explosion", "transform": {{"position": [20, 0, 0]}}}}]}},
                {{"at": 1.5, "spawn": [{{"prefab": "explosion", "transform": {{"position": [-20, 0, 0]}}}}]}}]}})",
            kCamera),
        made);
    const auto count = [&] {
        std::size_t near_first = 0;
        std::size_t all = 0;
        stage->world.query<const ParticlePool, const WorldTransform>().each(
            [&](const ParticlePool&, const WorldTransform& transform) {
                ++all;
                near_first += transform_point(transform.world, Vec3(0)).x > 15 ? 1 : 0;
            });
        return std::pair(near_first, all);
    };
    step_stage(*stage);
    CHECK(count().second == 0);
    advance_stage(*stage, 1.0);
    const auto [first, one] = count();
    CHECK(first > 8);
    CHECK(one == first);
    advance_stage(*stage, 2.0);
    CHECK(count().first == first);
    CHECK(count().second == 2 * first);
    advance_stage(*stage, 10.9);  // the first one is gone
    CHECK(count().first == 0);
    CHECK(count().second == first);
    advance_stage(*stage, 12.0);
    CHECK(count().second == 0);
}

TEST_CASE("explosion: a snapshot taken halfway continues with the same bits") {
    const test::TemporaryFolder folder;
    MadeAssets made;
    const std::string text = fmt::format(
        R"({{"title": "t", "include": ["explosion.effect.json"], "entities": [{},
                {{"name": "floor", "particle_collider": {{"shape": "plane"}}}},
                {{"name": "wall", "transform": {{"position": [2, 1, 0]}}, "particle_collider": {{"shape": "box"}}}},
                {{"name": "pool", "transform": {{"position": [0, 0.1, 3]}}, "water": {{"size": [4, 4]}}, "water_ripples": {{}}}}],
                "events": [{{"at": 0.5, "spawn": [{{"prefab": "explosion"}}]}}]}})",
        kCamera);
    const std::unique_ptr<Stage> stage = open_text(folder, text, made);
    advance_stage(*stage, 0.9);  // its second burst of smoke is due, at 0.95 s
    std::size_t particles = 0;
    stage->world.query<const ParticlePool>().each(
        [&](const ParticlePool& pool) { particles += pool.size(); });
    CHECK(particles > 300);
    const Result<std::vector<std::byte>> saved = save_snapshot(stage->world);
    REQUIRE(saved.ok());
    const auto hashes = [](Stage& of) {
        std::vector<std::uint64_t> found;
        for (int i = 0; i < 90; ++i) {
            step_stage(of);
            found.push_back(state_hash(of.world));
        }
        return found;
    };
    const std::vector<std::uint64_t> expected = hashes(*stage);
    CHECK(expected.front() != expected.back());
    REQUIRE(restore_snapshot(stage->world, *saved).ok());
    CHECK(hashes(*stage) == expected);
    // In another program there is nothing but the level and the snapshot.
    const std::unique_ptr<Stage> other = open_text(folder, text, made);
    REQUIRE(restore_snapshot(other->world, *saved).ok());
    CHECK(hashes(*other) == expected);
}

}  // namespace limn::effects_test
