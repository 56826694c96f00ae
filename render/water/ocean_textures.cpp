#include "render/water/ocean_textures.h"

#include "ecs/base/jobs.h"

#include <algorithm>

namespace limn {

namespace {

constexpr std::size_t kRowGrain = 32;

/// Samples a plane of `from` points per side at a resolution of `to`, a multiple of it.
class PlaneReader {
  public:
    PlaneReader(const std::vector<float>& plane, int from, int to)
        : plane_(plane), from_(from), ratio_(to / std::max(from, 1)) {}

    [[nodiscard]] float at(int x, int z) const {
        if (ratio_ == 1) {
            return plane_[index(x, z)];
        }
        const int i = x / ratio_;
        const int j = z / ratio_;
        const float u = static_cast<float>(x % ratio_) / static_cast<float>(ratio_);
        const float v = static_cast<float>(z % ratio_) / static_cast<float>(ratio_);
        const int right = (i + 1) % from_;
        const int below = (j + 1) % from_;
        return glm::mix(
            glm::mix(plane_[index(i, j)], plane_[index(right, j)], u),
            glm::mix(plane_[index(i, below)], plane_[index(right, below)], u), v);
    }

  private:
    [[nodiscard]] std::size_t index(int x, int z) const {
        return static_cast<std::size_t>(z) * static_cast<std::size_t>(from_)
               + static_cast<std::size_t>(x);
    }
    const std::vector<float>& plane_;
    int from_;
    int ratio_;
};

/// Writes texel(x, z) of a square with side `size`, rows in parallel.
template <typename Texel, typename T>
void fill(int size, std::vector<T>& texels, Texel&& texel) {
    const auto side = static_cast<std::size_t>(size);
    texels.resize(side * side);
    parallel_for(side, kRowGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t z = begin; z < end; ++z) {
            for (std::size_t x = 0; x < side; ++x) {
                texels[z * side + x] = texel(static_cast<int>(x), static_cast<int>(z));
            }
        }
    });
}

/// Downsamples a square of even side by 2 x 2 averaging, in place.
template <typename T>
void halve_map(int size, std::vector<T>& texels) {
    const auto side = static_cast<std::size_t>(size);
    const std::size_t half = side / 2;
    for (std::size_t z = 0; z < half; ++z) {
        const T* const above = texels.data() + 2 * z * side;
        const T* const below = above + side;
        T* const to = texels.data() + z * half;
        for (std::size_t x = 0; x < half; ++x) {
            to[x] = 0.25f * (above[2 * x] + above[2 * x + 1] + below[2 * x] + below[2 * x + 1]);
        }
    }
    texels.resize(half * half);
}

/// Uploads a square and its mip levels; leaves the last in `texels`. A software OpenGL takes
/// several times as long to generate them.
template <typename T>
void upload_levels(
    gpu::Texture& texture, int size, int layer, GLenum format, std::vector<T>& texels) {
    texture.upload<T>(texels, format, GL_FLOAT, 0, layer);
    for (int level = 1; size > 1; ++level, size /= 2) {
        halve_map(size, texels);
        texture.upload<T>(texels, format, GL_FLOAT, level, layer);
    }
}

void make_array(
    gpu::Texture& texture, const char* label, GLenum format, int size, int layers, int levels) {
    if (texture && texture.width() == size && texture.layers() == layers) {
        return;
    }
    texture = gpu::Texture(
        label, {.format = format,
                .width = size,
                .height = size,
                .depth = layers,
                .levels = levels,
                .target = GL_TEXTURE_2D_ARRAY});
    texture.set_wrap(GL_REPEAT);
}

/// shift_x, height, shift_z, interpolated from the previous step (0) to the last one (1).
void fill_shift(const OceanCascade& c, int size, float weight, std::vector<Vec4>& texels) {
    const PlaneReader now[3] = {
        {c.shift_x, c.size, size}, {c.height, c.size, size}, {c.shift_z, c.size, size}};
    const PlaneReader last[3] = {
        {c.previous_shift_x, c.size, size},
        {c.previous_height, c.size, size},
        {c.previous_shift_z, c.size, size}};
    if (weight == 1.0f) {
        fill(size, texels, [&](int x, int z) {
            return Vec4(now[0].at(x, z), now[1].at(x, z), now[2].at(x, z), 0);
        });
        return;
    }
    fill(size, texels, [&](int x, int z) {
        Vec4 texel(0);
        for (int i = 0; i < 3; ++i) {
            texel[i] = glm::mix(last[i].at(x, z), now[i].at(x, z), weight);
        }
        return texel;
    });
}

Vec3 wave_range(const OceanCascade& c) {
    const auto max_abs = [](const std::vector<float>& plane) {
        float largest = 0;
        for (const float v : plane) {
            largest = std::max(largest, std::abs(v));
        }
        return largest;
    };
    return {max_abs(c.shift_x), max_abs(c.height), max_abs(c.shift_z)};
}

float slope_variance(const OceanCascade& c) {
    double sum = 0;
    for (std::size_t i = 0; i < c.slope_x.size(); ++i) {
        sum += static_cast<double>(c.slope_x[i] * c.slope_x[i] + c.slope_z[i] * c.slope_z[i]);
    }
    return static_cast<float>(sum / std::max<double>(static_cast<double>(c.slope_x.size()), 1));
}

}  // namespace

void OceanTextures::update(std::span<const OceanSource> seas, bool with_previous) {
    layers_.assign(seas.size(), {});
    size_ = 0;
    layer_count_ = 0;
    for (std::size_t i = 0; i < seas.size(); ++i) {
        if (seas[i].state == nullptr) {
            continue;
        }
        layers_[i].first_layer = layer_count_;
        layers_[i].patches = static_cast<int>(seas[i].state->cascades.size());
        layer_count_ += layers_[i].patches;
        for (const OceanCascade& cascade : seas[i].state->cascades) {
            size_ = std::max(size_, cascade.size);
        }
    }
    if (layer_count_ == 0) {
        return;
    }
    make_array(shift_, "ocean shift", GL_RGBA32F, size_, layer_count_, 0);
    make_array(slope_, "ocean slope", GL_RGBA32F, size_, layer_count_, 0);
    make_array(foam_, "ocean foam", GL_RG32F, size_, layer_count_, 0);
    if (with_previous) {
        make_array(previous_shift_, "previous ocean shift", GL_RGBA32F, size_, layer_count_, 0);
    }
    for (std::size_t i = 0; i < seas.size(); ++i) {
        const OceanSource& sea = seas[i];
        for (int p = 0; p < layers_[i].patches; ++p) {
            const OceanCascade& c = sea.state->cascades[static_cast<std::size_t>(p)];
            const int layer = layers_[i].first_layer + p;
            const float step = sea.state->step;
            const auto weight = [&](float seconds) { return step > 0 ? 1 + seconds / step : 1.0f; };
            fill_shift(c, size_, weight(sea.now), texels_);
            upload_levels(shift_, size_, layer, GL_RGBA, texels_);
            if (with_previous) {
                fill_shift(c, size_, weight(sea.before), texels_);
                upload_levels(previous_shift_, size_, layer, GL_RGBA, texels_);
            }
            const PlaneReader planes[5] = {
                {c.slope_x, c.size, size_},
                {c.slope_z, c.size, size_},
                {c.shift_xx, c.size, size_},
                {c.shift_zz, c.size, size_},
                {c.shift_xz, c.size, size_}};
            fill(size_, texels_, [&](int x, int z) {
                return Vec4(
                    planes[0].at(x, z), planes[1].at(x, z), planes[2].at(x, z), planes[3].at(x, z));
            });
            upload_levels(slope_, size_, layer, GL_RGBA, texels_);
            const auto points = static_cast<std::size_t>(c.size) * static_cast<std::size_t>(c.size);
            const std::size_t first = static_cast<std::size_t>(p) * points;
            const bool foams = sea.foam != nullptr && sea.foam->coverage.size() >= first + points;
            const float* const cover = foams ? sea.foam->coverage.data() + first : nullptr;
            const int ratio = size_ / std::max(c.size, 1);
            fill(size_, pairs_, [&](int x, int z) {
                const auto at =
                    static_cast<std::size_t>(z / ratio) * static_cast<std::size_t>(c.size)
                    + static_cast<std::size_t>(x / ratio);
                return Vec2(planes[4].at(x, z), cover != nullptr ? cover[at] : 0.0f);
            });
            upload_levels(foam_, size_, layer, GL_RG, pairs_);
            layers_[i].margin += wave_range(c);
            layers_[i].variance[p] = slope_variance(c);
        }
    }
}

}  // namespace limn
