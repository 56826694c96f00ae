// The prefabs of content/effects: each can be placed by itself, and what is shot once leaves
// nothing.

#include "content/app/commands/stage.h"
#include "content/load/files/json_document.h"
#include "content/load/made_assets.h"
#include "ecs/base/gravity.h"
#include "ecs/base/log.h"
#include "ecs/components/beam.h"
#include "ecs/components/name.h"
#include "ecs/components/particles.h"
#include "ecs/components/transform.h"
#include "ecs/snapshot.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
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
            CHECK(name == "townspeople.effect.json");  // only materials and meshes
            continue;
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

namespace {

struct Drop {
    Vec3 at = {0, 0, 0};
    Vec3 velocity = {0, 0, 0};
    float share = 0;  ///< of its life that is over
};

/// The particles of an emitter of this name.
std::vector<Drop> drops_of(Stage& stage, std::string_view name) {
    std::vector<Drop> drops;
    stage.world.query<const Name, const ParticlePool>().each(
        [&](const Name& own, const ParticlePool& pool) {
            for (std::size_t i = 0; i < (own.text == name ? pool.size() : 0); ++i) {
                drops.push_back(
                    {.at = {pool.x[i], pool.y[i], pool.z[i]},
                     .velocity = {pool.vx[i], pool.vy[i], pool.vz[i]},
                     .share = pool.age[i] / pool.life[i]});
            }
        });
    return drops;
}

std::unique_ptr<Stage>
open_water(const test::TemporaryFolder& folder, std::string_view prefab, MadeAssets& made) {
    std::unique_ptr<Stage> stage = open_text(
        folder,
        fmt::format(
            R"({{"title": "t", "include": ["water.effect.json"], "entities": [{}, {{"prefab": "{}"}}]}})",
            kCamera, prefab),
        made);
    step_stage(*stage);
    return stage;
}

/// Mean of a value of the drops for which it is given, and how many those are.
template <typename Value>
std::pair<float, int> mean_of(const std::vector<Drop>& drops, Value&& value) {
    double sum = 0;
    int count = 0;
    for (const Drop& drop : drops) {
        if (const std::optional<float> one = value(drop)) {
            sum += static_cast<double>(*one);
            ++count;
        }
    }
    return {static_cast<float>(sum / std::max(count, 1)), count};
}

float from_axis(const Drop& drop) {
    return std::hypot(drop.at.x, drop.at.z);
}

}  // namespace

TEST_CASE("fountain: from the first step its jet is one at the nozzle, spreads, and ends in the "
          "basin") {
    const test::TemporaryFolder folder;
    MadeAssets made;
    const std::unique_ptr<Stage> stage = open_water(folder, "fountain", made);
    for (int moment = 0; moment < 2; ++moment) {
        CAPTURE(moment);
        std::vector<Drop> jet = drops_of(*stage, "jet");
        REQUIRE(jet.size() > 1800);
        const auto width = [&](float low, float high, bool rises) {
            return mean_of(jet, [&](const Drop& drop) {
                const bool is_in = drop.at.y > low && drop.at.y < high;
                return is_in && (drop.velocity.y > 0) == rises ? std::optional(from_axis(drop))
                                                               : std::nullopt;
            });
        };
        const auto [nozzle, at_nozzle] = width(1.17f, 1.3f, true);
        const auto [top, at_top] = width(2.1f, 2.4f, true);
        const auto [falling, that_fall] = width(0.8f, 1.4f, false);
        CHECK(std::min({at_nozzle, at_top, that_fall}) > 30);
        CHECK(nozzle < 0.02f);
        CHECK(top > 2 * nozzle);
        CHECK(falling > 1.5f * top);
        std::sort(
            jet.begin(), jet.end(), [](const Drop& a, const Drop& b) { return a.at.y < b.at.y; });
        CHECK(jet[jet.size() - jet.size() / 100].at.y == test::near(2.4).epsilon(0.08));
        CHECK(jet[jet.size() / 25].at.y > 0.3f);  // water stands at 0.42
        CHECK(jet[jet.size() / 25].at.y < 0.8f);
        advance_stage(*stage, 4);
    }
    const auto [lowest, ends] = mean_of(drops_of(*stage, "curtain"), [](const Drop& drop) {
        CHECK(from_axis(drop) > 0.5f);  // over the rim
        CHECK(from_axis(drop) < 1.2f);  // into the basin
        return drop.share > 0.95f ? std::optional(drop.at.y) : std::nullopt;
    });
    CHECK(ends > 10);
    CHECK(lowest == test::near(0.45).epsilon(0.15));
}

TEST_CASE("waterfall: its strips fall freely from the lip to the foot, where its foam leaps up") {
    const test::TemporaryFolder folder;
    MadeAssets made;
    const std::unique_ptr<Stage> stage = open_water(folder, "waterfall", made);
    for (int moment = 0; moment < 2; ++moment) {
        CAPTURE(moment);
        for (const char* const name : {"sheet", "strands"}) {
            CAPTURE(name);
            const std::vector<Drop> water = drops_of(*stage, name);
            REQUIRE(water.size() > 300);
            int ends = 0;
            for (const Drop& drop : water) {
                CHECK(std::abs(drop.at.x) < 1.6f);
                const float fallen = std::max(-drop.at.y, 0.0f);
                const float expected = std::sqrt(2 * static_cast<float>(kGravity) * fallen);
                CHECK(glm::length(drop.velocity) > 0.85f * expected);
                CHECK(glm::length(drop.velocity) < expected + 2.2f);
                ends += drop.at.y < -4 ? 1 : 0;
            }
            CHECK(ends > 20);
            const auto strikes = [&](auto&& value) {
                return mean_of(
                           water,
                           [&](const Drop& drop) {
                               return drop.share > 0.96f ? std::optional(value(drop))
                                                         : std::nullopt;
                           })
                    .first;
            };
            const std::vector<Drop> foam = drops_of(*stage, "foam");
            REQUIRE(foam.size() > 30);
            const auto everywhere = [&](auto&& value) {
                return mean_of(foam, [&](const Drop& drop) { return std::optional(value(drop)); })
                    .first;
            };
            const auto forward = [](const Drop& drop) { return drop.at.z; };
            CHECK(
                strikes([](const Drop& drop) { return drop.at.y; })
                == test::near(-4.75).epsilon(0.05));
            CHECK(std::abs(strikes(forward) - everywhere(forward)) < 0.25f);
            int leaps = 0;
            for (const Drop& drop : foam) {
                CHECK(drop.at.y < -3.8f);
                CHECK((drop.share > 0.5f || drop.at.y > -5.2f));
                leaps += drop.velocity.y > 0.5f ? 1 : 0;
            }
            CHECK(leaps > static_cast<int>(foam.size() / 4));
        }
        advance_stage(*stage, 4);
    }
    // Mist spreads and drifts off, and is not blown into the ground.
    const std::vector<Drop> mist = drops_of(*stage, "mist");
    const auto height = [&](float from, float to) {
        return mean_of(
                   mist,
                   [&](const Drop& drop) {
                       return drop.share >= from && drop.share < to ? std::optional(drop.at.y)
                                                                    : std::nullopt;
                   })
            .first;
    };
    CHECK(mist.size() > 40);
    CHECK(height(0.6f, 1) > height(0, 0.2f) + 0.3f);
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
