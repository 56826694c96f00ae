#include "render/shadow/shadow_atlas.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace limn::shadow_atlas_test {
namespace {

bool overlap(const AtlasRect& a, const AtlasRect& b) {
    return a.x < b.x + b.size && b.x < a.x + a.size && a.y < b.y + b.size && b.y < a.y + a.size;
}

}  // namespace

TEST_CASE("shadow atlas: squares never overlap, and the whole atlas can be allocated") {
    ShadowAtlas atlas(1024);
    std::vector<AtlasRect> taken;
    for (const int size : {512, 16, 256, 256, 64, 512, 512}) {
        const auto rect = atlas.allocate(size);
        if (rect) {
            taken.push_back(*rect);
        }
    }
    while (const auto rect = atlas.allocate(16)) {
        taken.push_back(*rect);
    }
    int area = 0;
    for (std::size_t i = 0; i < taken.size(); ++i) {
        area += taken[i].size * taken[i].size;
        CHECK(taken[i].x >= 0);
        CHECK(taken[i].x + taken[i].size <= 1024);
        CHECK(taken[i].y + taken[i].size <= 1024);
        for (std::size_t k = 0; k < std::min<std::size_t>(i, 16); ++k) {
            CHECK_FALSE(overlap(taken[i], taken[k]));
        }
    }
    CHECK(area == 1024 * 1024);
}

TEST_CASE("shadow atlas: released squares merge again, in any order") {
    ShadowAtlas atlas(256);
    std::mt19937 random(5);
    for (int round = 0; round < 20; ++round) {
        std::vector<AtlasRect> taken;
        while (const auto rect = atlas.allocate(16 << (random() % 3))) {
            taken.push_back(*rect);
        }
        std::shuffle(taken.begin(), taken.end(), random);
        for (const AtlasRect& rect : taken) {
            atlas.release(rect);
        }
        const auto whole = atlas.allocate(256);
        REQUIRE(whole.has_value());
        CHECK(*whole == AtlasRect{0, 0, 256});
        atlas.release(*whole);
    }
}

TEST_CASE("shadow atlas: a square larger than the atlas is refused") {
    ShadowAtlas atlas(64);
    CHECK_FALSE(atlas.allocate(128).has_value());
    CHECK(atlas.allocate(64).has_value());
    CHECK_FALSE(atlas.allocate(1).has_value());
}

}  // namespace limn::shadow_atlas_test
