#include "render/material/material_blocks.h"
#include "render/shaders/material_blocks_gpu.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"

#include <algorithm>
#include <vector>

namespace limn::test::material_blocks_test {
namespace {

/// Texel of a block of a kind, counted from the front of the vector.
std::size_t block_offset(const Vec4& blocks, std::uint32_t kind) {
    const auto offsets =
        static_cast<std::uint32_t>(blocks[1 + static_cast<int>(kind / layout::kBlocksPerFloat)]);
    const std::uint32_t offset =
        offsets >> kind % layout::kBlocksPerFloat * layout::kBlockOffsetBits
        & ((1u << layout::kBlockOffsetBits) - 1);
    return static_cast<std::size_t>(blocks.x) + offset;
}

/// Red on the left, green on the right; or reversed.
ImageData halves(bool red_first = true) {
    ImageData image = {
        .name = "halves", .width = 2, .height = 1, .pixels = {255, 0, 0, 255, 0, 255, 0, 255}};
    if (!red_first) {
        std::rotate(image.pixels.begin(), image.pixels.begin() + 4, image.pixels.end());
    }
    return image;
}

/// Squares of side 2, a row of them, 2.5 m apart.
class Row : public Scene {
  public:
    Row() : image_(add(halves())), square_(add(make_square())) {
        shine(PointLight{.intensity = 40, .radius = 0}, at({0, 1, 3}));
    }
    /// With none, with some and with all blocks.
    [[nodiscard]] std::vector<Material> kinds() const {
        const Material plain = {.base_color = {0.7f, 0.6f, 0.5f, 1}};
        Material moved = plain;
        moved.base_color_texture = {.image = image_, .nearest = true, .offset = {0.5f, 0}};
        Material shiny = plain;
        shiny.shading = ShadingModel::Blinn;
        shiny.specular = {0.2f, 0.4f, 0.6f};
        Material soft = moved;
        soft.shading = ShadingModel::Skin;
        soft.skin_color = {0.9f, 0.3f, 0.1f};
        soft.wide_rim = true;
        return {plain, moved, shiny, plain, soft, moved};
    }
    void put(const Material& material, std::size_t i) {
        const Vec3 p = {2.5f * static_cast<float>(i) - 6.25f, 0, 0};
        place(square_, add(material), at(p));
    }
    gpu::FloatImage picture() { return radiance(look({0, 0, 6}, {0, 0, 0}, 192, 64)); }

  private:
    ImageId image_;
    MeshId square_;
};

}  // namespace

TEST_CASE("material blocks: a material has the blocks that it needs, one after another") {
    std::vector<Vec4> blocks(7);  // of others
    CHECK(append_blocks(Material{}, blocks).x == 7);
    CHECK(blocks.size() == 7);

    const Material phong = {.shading = ShadingModel::Phong, .specular = {1, 2, 3}, .shininess = 40};
    const Vec4 offsets = append_blocks(phong, blocks);
    REQUIRE(blocks.size() == 8);
    CHECK(blocks[block_offset(offsets, layout::kClassicBlock)] == Vec4(1, 2, 3, 40));

    Material skin = {.shading = ShadingModel::Skin, .skin_color = {4, 5, 6}, .wide_rim = true};
    skin.normal_texture = {.image = {0}, .offset = {0.25f, 0.5f}};
    const Vec4 all = append_blocks(skin, blocks);
    REQUIRE(blocks.size() == 8 + 2 + 1 + 1);
    CHECK(blocks[block_offset(all, layout::kUvBlock) + 1] == Vec4(0.25f, 0.5f, 0, 0));
    CHECK(blocks[block_offset(all, layout::kClassicBlock)].w == 50);
    CHECK(blocks[block_offset(all, layout::kSkinBlock)] == Vec4(4, 5, 6, 1));
}

TEST_CASE("material blocks: next to materials with other blocks, each looks the same as alone") {
    Row all;
    const std::vector<Material> kinds = all.kinds();
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        all.put(kinds[i], i);
    }
    const gpu::FloatImage together = all.picture();
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        CAPTURE(i);
        Row alone;
        alone.put(kinds[i], i);
        const gpu::FloatImage one = alone.picture();
        int compared = 0;
        for (std::size_t k = 0; k < one.pixels.size(); k += 4) {
            if (one.pixels[k + 3] > 0) {
                for (std::size_t c = k; c < k + 3; ++c) {
                    CHECK(one.pixels[c] == test::near(together.pixels[c]).epsilon(1e-4));
                }
                ++compared;
            }
        }
        CHECK(compared > 50);
    }
}

TEST_CASE("material blocks: the contents of a block do not depend on previous ones") {
    Row with_uv;
    Material soft = with_uv.kinds()[4];
    with_uv.put(soft, 4);
    // The same without a uv map, from an image that is moved instead.
    Row without;
    soft.base_color_texture = {.image = without.add(halves(false)), .nearest = true};
    without.put(soft, 4);
    const gpu::FloatImage moved = with_uv.picture();
    const gpu::FloatImage plain = without.picture();
    CHECK(*std::max_element(plain.pixels.begin(), plain.pixels.end()) > 0.1f);
    for (std::size_t i = 0; i < plain.pixels.size(); ++i) {
        CHECK(moved.pixels[i] == test::near(plain.pixels[i]).epsilon(1e-5));
    }
}

}  // namespace limn::test::material_blocks_test
