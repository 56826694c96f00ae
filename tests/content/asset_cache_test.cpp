#include "content/load/files/asset_cache.h"
#include "content/load/files/atomic_file.h"
#include "content/load/made_assets.h"
#include "content/make/find_kind.h"
#include "content/make/head/head.h"
#include "tests/support.h"

#include <doctest/doctest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

namespace limn::asset_cache_test {
namespace {

PatternMaps numbered_maps(std::uint8_t first, int size) {
    PatternMaps maps;
    for (ImageData* image :
         {&maps.base_color, &maps.normal, &maps.orm, &maps.motion, &maps.positive_light,
          &maps.negative_light}) {
        image->name = "image " + std::to_string(first);
        image->width = size;
        image->height = 1;
        image->srgb = image == &maps.base_color;
        image->format = image == &maps.motion ? PixelFormat::Rgba16F : PixelFormat::Rgba8;
        image->pixels.assign(static_cast<std::size_t>(8 * size), first++);
    }
    return maps;
}

bool is_equal(const ImageData& a, const ImageData& b) {
    return a.name == b.name && a.width == b.width && a.height == b.height && a.format == b.format
           && a.srgb == b.srgb && a.pixels == b.pixels;
}

std::vector<std::string> files_in(const test::TemporaryFolder& folder) {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        files.push_back(entry.path().string());
    }
    return files;
}

}  // namespace

TEST_CASE("asset cache: a pattern of a key is found again with all its images") {
    const test::TemporaryFolder folder;
    const AssetCache cache(folder.path());
    const PatternMaps maps = numbered_maps(10, 5);
    CHECK_FALSE(cache.find_pattern("a"));
    cache.keep("a", maps);
    const std::optional<PatternMaps> found = AssetCache(folder.path()).find_pattern("a");
    REQUIRE(found);
    CHECK(is_equal(found->base_color, maps.base_color));
    CHECK(is_equal(found->normal, maps.normal));
    CHECK(is_equal(found->orm, maps.orm));
    CHECK(is_equal(found->motion, maps.motion));
    CHECK(is_equal(found->positive_light, maps.positive_light));
    CHECK(is_equal(found->negative_light, maps.negative_light));
    CHECK_FALSE(cache.find_pattern("b"));
}

TEST_CASE("asset cache: a head with skin, shapes and regions is found again as it was") {
    const test::TemporaryFolder folder;
    const AssetCache cache(folder.path());
    const MeshKind& kind = *find_kind(mesh_kinds(), "head");
    const MeshData head = kind.make(AnyComponent::of(HeadShape{}).data(), Assets{});
    REQUIRE_FALSE(head.morphs.empty());
    REQUIRE_FALSE(head.regions.empty());
    cache.keep("head", head);
    const std::optional<MeshData> found = cache.find_mesh("head");
    REQUIRE(found);
    CHECK(found->name == head.name);
    CHECK(found->positions == head.positions);
    CHECK(found->normals == head.normals);
    CHECK(found->tangents == head.tangents);
    CHECK(found->uvs == head.uvs);
    CHECK(found->colors == head.colors);
    CHECK(found->indices == head.indices);
    CHECK(found->skin.first == head.skin.first);
    CHECK(found->skin.joints == head.skin.joints);
    CHECK(found->skin.weights == head.skin.weights);
    CHECK(found->bounds.max == head.bounds.max);
    REQUIRE(found->morphs.size() == head.morphs.size());
    for (std::size_t i = 0; i < head.morphs.size(); ++i) {
        CHECK(found->morphs[i].name == head.morphs[i].name);
        CHECK(found->morphs[i].action_unit == head.morphs[i].action_unit);
        CHECK(found->morphs[i].vertices == head.morphs[i].vertices);
        CHECK(found->morphs[i].positions == head.morphs[i].positions);
        CHECK(found->morphs[i].normals == head.morphs[i].normals);
        CHECK(found->morphs[i].drivers == head.morphs[i].drivers);
    }
    REQUIRE(found->regions.size() == head.regions.size());
    for (std::size_t i = 0; i < head.regions.size(); ++i) {
        CHECK(found->regions[i].name == head.regions[i].name);
        CHECK(found->regions[i].weights == head.regions[i].weights);
        CHECK(found->regions[i].across == head.regions[i].across);
    }
}

TEST_CASE("asset cache: a damaged file is as none, whichever byte it is or where it ends") {
    const test::TemporaryFolder folder;
    const AssetCache cache(folder.path());
    cache.keep("a", numbered_maps(1, 1));
    const std::string path = files_in(folder).at(0);
    const std::vector<std::byte> bytes = *read_file(path);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        std::vector<std::byte> damaged = bytes;
        damaged[i] ^= std::byte{1};
        REQUIRE(write_file(path, damaged));
        CHECK_FALSE(cache.find_pattern("a"));
        REQUIRE(write_file(path, std::span(bytes).first(i)));
        CHECK_FALSE(cache.find_pattern("a"));
    }
    cache.keep("a", numbered_maps(1, 1));
    CHECK(cache.find_pattern("a"));
    CHECK_FALSE(cache.find_mesh("a"));  // nor is one of another kind
}

TEST_CASE("asset cache: those used longest ago go where there would be too many bytes") {
    const test::TemporaryFolder folder;
    const AssetCache cache(folder.path(), 5000);
    cache.keep("a", numbered_maps(1, 32));  // 1.7 kB
    cache.keep("b", numbered_maps(2, 32));
    for (const std::string& path : files_in(folder)) {
        std::filesystem::last_write_time(
            path, std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
    }
    CHECK(cache.find_pattern("a"));
    cache.keep("c", numbered_maps(3, 32));
    CHECK(cache.find_pattern("a"));
    CHECK_FALSE(cache.find_pattern("b"));
    CHECK(cache.find_pattern("c"));
}

TEST_CASE("asset cache: without a folder, or with one that cannot be, nothing is kept") {
    const test::TemporaryFolder folder;
    REQUIRE(write_file(folder.file("file"), std::string("not a folder")));
    for (const AssetCache& cache : {AssetCache(""), AssetCache(folder.file("file"))}) {
        cache.keep("a", numbered_maps(1, 1));
        CHECK_FALSE(cache.find_pattern("a"));
    }
}

TEST_CASE("asset cache: what takes long to generate is generated once by two programs") {
    const test::TemporaryFolder folder;
    static int calls = 0;
    calls = 0;
    PatternKind slow = *find_kind(pattern_kinds(), "marble");
    slow.make = [](const void*) {
        ++calls;
        std::this_thread::sleep_for(std::chrono::milliseconds(30));
        return numbered_maps(7, 4);
    };
    const AnyComponent parameters = AnyComponent::of(MarblePattern{});
    for (int program = 0; program < 2; ++program) {
        MadeAssets made{AssetCache(folder.path())};
        CHECK(is_equal(made.pattern(slow, parameters).orm, numbered_maps(7, 4).orm));
        CHECK(calls == 1);
    }
}

}  // namespace limn::asset_cache_test
