#pragma once

#include "render/particles/layered_draws.h"
#include "render/variant.h"

#include <array>
#include <cstdint>

namespace limn {

namespace gpu {
class Device;
class Program;
}  // namespace gpu

/// The output that particles are drawn into.
enum class SpritePass : std::uint8_t {
    Color,
    Velocity,   ///< of the pixels that they cover
    LensDepth,  ///< depth of the pixels that they cover, for the lens to focus on
};
inline constexpr std::size_t kSpritePasses = 3;

/// The programs that draw particles: one for each pass and shape, in variants.
class SpritePrograms {
  public:
    explicit SpritePrograms(gpu::Device& device);

    /// Null if it does not compile. Adds the definitions of the pass and of the shape.
    [[nodiscard]] const gpu::Program* find(SpritePass pass, SpriteShape shape, Variant variant);

  private:
    std::array<std::array<ProgramVariants, kSpriteShapes>, kSpritePasses> programs_;
};

/// Draws `count` particles with the program that is in use.
void draw_shape(gpu::Device& device, SpriteShape shape, int count);

}  // namespace limn
