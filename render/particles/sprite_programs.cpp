#include "render/particles/sprite_programs.h"

#include "render/gpu/device.h"

namespace limn {
namespace {

struct ShapeRow {
    const char* vertex;
    const char* definition;  ///< null: none
    void (gpu::Device::*draw)(int count);
};
constexpr std::array<ShapeRow, kSpriteShapes> kShapeRows = {{
    {"particle.vert", nullptr, &gpu::Device::draw_quads},          // Quad
    {"particle_point.vert", "POINTS", &gpu::Device::draw_points},  // SmallDisc
    {"particle_point.vert", "POINTS", &gpu::Device::draw_points},  // Point
}};

struct PassRow {
    const char* fragment;
    const char* definition;  ///< null: none
};
constexpr std::array<PassRow, kSpritePasses> kPassRows = {{
    {"particle.frag", nullptr},              // Color
    {"particle_velocity.frag", "VELOCITY"},  // Velocity
    {"particle_focus.frag", "FOCUS"},        // LensDepth
}};

const ShapeRow& shape_row(SpriteShape shape) {
    return kShapeRows[static_cast<std::size_t>(shape)];
}
const PassRow& pass_row(SpritePass pass) {
    return kPassRows[static_cast<std::size_t>(pass)];
}

std::array<ProgramVariants, kSpriteShapes> programs_of(gpu::Device& device, const PassRow& pass) {
    const auto program = [&](const ShapeRow& shape) {
        return ProgramVariants(device, {.vertex = shape.vertex, .fragment = pass.fragment});
    };
    return {program(kShapeRows[0]), program(kShapeRows[1]), program(kShapeRows[2])};
}

}  // namespace

SpritePrograms::SpritePrograms(gpu::Device& device)
    : programs_{
        programs_of(device, kPassRows[0]), programs_of(device, kPassRows[1]),
        programs_of(device, kPassRows[2])} {}

const gpu::Program* SpritePrograms::find(SpritePass pass, SpriteShape shape, Variant variant) {
    for (const char* const definition : {pass_row(pass).definition, shape_row(shape).definition}) {
        if (definition != nullptr) {
            variant.add(definition);
        }
    }
    return programs_[static_cast<std::size_t>(pass)][static_cast<std::size_t>(shape)].get(variant);
}

void draw_shape(gpu::Device& device, SpriteShape shape, int count) {
    (device.*shape_row(shape).draw)(count);
}

}  // namespace limn
