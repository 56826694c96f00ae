#include "content/bake/relief_map.h"

#include "ecs/base/check.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: relief.filter, relief.map-format

namespace limn {

namespace {

template <typename Code>
std::vector<Code> map_codes(const BakedMap& map, int channels, float largest) {
    LIMN_CHECK(channels >= 1 && channels <= 4);
    std::vector<Code> codes;
    codes.reserve(map.texels.size() * static_cast<std::size_t>(channels));
    for (const Vec4& texel : map.texels) {
        for (int c = 0; c < channels; ++c) {
            const float value = std::isnan(texel[c]) ? 0.0f : std::clamp(texel[c], 0.0f, 1.0f);
            codes.push_back(static_cast<Code>(std::lround(largest * value)));
        }
    }
    return codes;
}

bool is_hole(const ReliefTexel& texel, ReliefLayout layout) {
    return layout == ReliefLayout::Double && texel.depth >= 1 && texel.back >= 1;
}

/// `texels`: one to six.
ReliefTexel average_relief(std::span<const ReliefTexel> texels, ReliefLayout layout) {
    ReliefTexel sum = {.normal = Vec3(0), .depth = 0, .back = 0, .cone_ratio = 1};
    float count = 0;
    for (const ReliefTexel& texel : texels) {
        if (!is_hole(texel, layout)) {
            sum.normal += texel.normal;
            sum.depth += texel.depth;
            sum.back += texel.back;
            sum.cone_ratio = std::min(sum.cone_ratio, texel.cone_ratio);
            count += 1;
        }
    }
    if (count == 0) {
        return {};
    }
    sum.normal = normalize_or(sum.normal, Vec3(0, 0, 1));
    sum.depth /= count;
    sum.back /= count;
    return sum;
}

}  // namespace

BakedMap make_baked_map(int width, int height, const Vec4& value) {
    LIMN_CHECK(width > 0 && height > 0);
    BakedMap map = {.width = width, .height = height};
    map.texels.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), value);
    return map;
}

Vec3 encode_normal(const Vec3& normal) {
    return 0.5f * normal + 0.5f;
}

Vec3 decode_normal(const Vec3& rgb) {
    return normalize_or(2.0f * rgb - 1.0f, Vec3(0, 0, 1));
}

Vec4 encode_relief(const ReliefTexel& texel, ReliefLayout layout) {
    const Vec3 rgb = encode_normal(texel.normal);
    switch (layout) {
    case ReliefLayout::Single:
        break;
    case ReliefLayout::Double:
        return {rgb.x, rgb.y, texel.back, texel.depth};
    case ReliefLayout::Cone:
        return {rgb.x, rgb.y, texel.cone_ratio, texel.depth};
    }
    return {rgb, texel.depth};
}

ReliefTexel decode_relief(const Vec4& rgba, ReliefLayout layout) {
    ReliefTexel texel = {.depth = rgba.w};
    if (layout == ReliefLayout::Single) {
        texel.normal = decode_normal(Vec3(rgba));
        return texel;
    }
    const Vec2 xy = {2 * rgba.x - 1, 2 * rgba.y - 1};
    texel.normal =
        glm::normalize(Vec3(xy, std::sqrt(std::max(1 - glm::dot(xy, xy), 0.0f)) + 1e-6f));
    (layout == ReliefLayout::Double ? texel.back : texel.cone_ratio) = rgba.z;
    return texel;
}

BakedMap next_relief_level(const BakedMap& map, ReliefLayout layout) {
    BakedMap next = make_baked_map(std::max(map.width / 2, 1), std::max(map.height / 2, 1));
    // A texel covers those from i * n / m on; the last row or column of an odd size counts, too.
    const auto first = [](int i, int size, int next_size) { return i * size / next_size; };
    std::vector<ReliefTexel> covered;
    for (int y = 0; y < next.height; ++y) {
        for (int x = 0; x < next.width; ++x) {
            covered.clear();
            for (int j = first(y, map.height, next.height);
                 j < first(y + 1, map.height, next.height); ++j) {
                for (int i = first(x, map.width, next.width);
                     i < first(x + 1, map.width, next.width); ++i) {
                    covered.push_back(decode_relief(map.texels[map.at(i, j)], layout));
                }
            }
            next.texels[next.at(x, y)] = encode_relief(average_relief(covered, layout), layout);
        }
    }
    return next;
}

std::vector<std::uint8_t> map_bytes(const BakedMap& map, int channels) {
    return map_codes<std::uint8_t>(map, channels, 255);
}

std::vector<std::uint16_t> map_words(const BakedMap& map, int channels) {
    return map_codes<std::uint16_t>(map, channels, 65535);
}

}  // namespace limn
