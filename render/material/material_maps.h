#pragma once

#include "ecs/components/surface.h"
#include "render/material/material_layers.h"
#include "render/shaders/material_maps_gpu.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace limn {

// The maps of a material: which it has, their texture units and their texture coordinates. A new
// map is a slot number in shaders/material_maps_gpu.h, a row in material_maps.cpp and a field of
// Material.

struct MapSlot {
    std::uint32_t number;
    const char* definition;  ///< of shaders: its value is the texture unit
    TextureSlot Material::*texture;
    bool trilinear;            ///< also on a software OpenGL
    MaterialLayers layer = 0;  ///< that reads it; 0: all materials do
};
/// By number.
[[nodiscard]] std::span<const MapSlot> map_slots();

[[nodiscard]] inline bool is_used(const TextureSlot& slot) {
    return slot.image.index != kNoAsset;
}

/// How its normal map is filtered. Normals in mesh space have no slopes.
[[nodiscard]] NormalMips normal_mips_of(const Material& material);

/// Whether a material has and reads this map.
[[nodiscard]] bool has_map(const Material& material, const MapSlot& slot);

/// Slots with their texture units. Four bits per slot: unit + 1, or 0 if there is no such map.
class MapUnits {
  public:
    void set(std::uint32_t slot, std::uint32_t unit) {
        remove(slot);
        bits_[slot / kPerWord] |= std::uint64_t{unit + 1} << shift(slot);
    }
    void remove(std::uint32_t slot) {
        bits_[slot / kPerWord] &= ~(std::uint64_t{15} << shift(slot));
    }
    [[nodiscard]] bool has(std::uint32_t slot) const { return nibble(slot) != 0; }
    /// Whether any of `slots`, a set of bits, exists.
    [[nodiscard]] bool has_any(std::uint32_t slots) const {
        MapUnits some;
        some.add(*this, slots);
        return some != MapUnits{};
    }
    /// The map must exist.
    [[nodiscard]] std::uint32_t unit(std::uint32_t slot) const {
        return static_cast<std::uint32_t>(nibble(slot)) - 1;
    }
    /// Adds those of `other` that are in `slots`, a set of bits.
    void add(const MapUnits& other, std::uint32_t slots) {
        for (std::uint32_t slot = 0; slot < layout::kMaxMapSlots; ++slot) {
            if ((slots >> slot & 1) != 0 && other.has(slot)) {
                set(slot, other.unit(slot));
            }
        }
    }
    void remove_all(std::uint32_t slots) {
        for (std::uint32_t slot = 0; slot < layout::kMaxMapSlots; ++slot) {
            if ((slots >> slot & 1) != 0) {
                remove(slot);
            }
        }
    }
    /// A hash.
    [[nodiscard]] std::uint64_t key() const { return bits_[0] ^ bits_[1] * 0xc2b2ae3d27d4eb4full; }
    bool operator==(const MapUnits&) const = default;

  private:
    static constexpr std::uint32_t kPerWord = 16;
    [[nodiscard]] static std::uint32_t shift(std::uint32_t slot) { return 4 * (slot % kPerWord); }
    [[nodiscard]] std::uint64_t nibble(std::uint32_t slot) const {
        return bits_[slot / kPerWord] >> shift(slot) & 15;
    }

    std::array<std::uint64_t, 2> bits_ = {};
};
static_assert(layout::kMaxMapSlots <= 2 * 16 && layout::kMapUnits < 15);

/// A texture array and the sampler of a map that reads it.
struct MapBinding {
    std::uint32_t array = 0;    ///< of ImagePool
    std::uint32_t sampler = 0;  ///< of MaterialPool
    bool encoded = false;       ///< read without decoding sRGB
    bool operator==(const MapBinding&) const = default;
};

/// The bindings of a material's maps, by texture unit. Equal maps share a unit.
class MapBindings {
  public:
    /// The unit of a map; none if all units are in use.
    [[nodiscard]] std::optional<std::uint32_t> add(const MapBinding& map);
    [[nodiscard]] std::span<const MapBinding> used() const {
        return std::span(bindings_).first(count_);
    }
    bool operator==(const MapBindings&) const = default;

  private:
    std::array<MapBinding, layout::kMapUnits> bindings_;
    std::uint32_t count_ = 0;
};

/// Sets the layer of a slot in MaterialRecord::maps, which must still be 0.
void set_layer(std::span<Vec4> maps, std::uint32_t slot, std::uint32_t layer);

/// Whether both use the same set of texture coordinates and the same transform.
[[nodiscard]] bool same_uv(const TextureSlot& a, const TextureSlot& b);

/// The SurfaceFeature kUvMap, kUvMaps or, if all maps use the first uv set untransformed, 0.
[[nodiscard]] std::uint32_t uv_feature(const Material& material);

/// Appends the kUvBlock of a material; false if uv_feature() is 0.
bool append_uv_block(const Material& material, std::vector<Vec4>& blocks);

}  // namespace limn
