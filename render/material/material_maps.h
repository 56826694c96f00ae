#pragma once

#include "ecs/components/surface.h"
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
    bool trilinear;  ///< also on a software OpenGL
};
/// By number.
[[nodiscard]] std::span<const MapSlot> map_slots();

[[nodiscard]] inline bool is_used(const TextureSlot& slot) {
    return slot.image.index != kNoAsset;
}

/// Slots with their texture units. Four bits per slot: unit + 1, or 0 if there is no such map.
class MapUnits {
  public:
    void set(std::uint32_t slot, std::uint32_t unit) {
        remove(slot);
        bits_ |= std::uint64_t{unit + 1} << 4 * slot;
    }
    void remove(std::uint32_t slot) { bits_ &= ~(std::uint64_t{15} << 4 * slot); }
    [[nodiscard]] bool has(std::uint32_t slot) const { return (bits_ >> 4 * slot & 15) != 0; }
    /// Whether any of `slots`, a set of bits, exists.
    [[nodiscard]] bool has_any(std::uint32_t slots) const {
        MapUnits some;
        some.add(*this, slots);
        return some.bits_ != 0;
    }
    /// The map must exist.
    [[nodiscard]] std::uint32_t unit(std::uint32_t slot) const {
        return static_cast<std::uint32_t>(bits_ >> 4 * slot & 15) - 1;
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
    [[nodiscard]] std::uint64_t bits() const { return bits_; }
    bool operator==(const MapUnits&) const = default;

  private:
    std::uint64_t bits_ = 0;
};
static_assert(4 * layout::kMaxMapSlots <= 64 && layout::kMapUnits < 15);

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
void set_layer(Vec4& maps, std::uint32_t slot, std::uint32_t layer);

/// Whether both use the same set of texture coordinates and the same transform.
[[nodiscard]] bool same_uv(const TextureSlot& a, const TextureSlot& b);

/// The SurfaceFeature kUvMap, kUvMaps or, if all maps use the first uv set untransformed, 0.
[[nodiscard]] std::uint32_t uv_feature(const Material& material);

/// Appends the kUvBlock of a material; false if uv_feature() is 0.
bool append_uv_block(const Material& material, std::vector<Vec4>& blocks);

}  // namespace limn
