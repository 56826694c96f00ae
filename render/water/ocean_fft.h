#pragma once

#include "ecs/components/ocean.h"
#include "render/gpu/buffer.h"
#include "render/gpu/device.h"
#include "render/graph/frame_graph.h"

namespace limn {

// The fields of an ocean on the GPU, from the spectrum that the simulation drew: the same as those
// of OceanState to 1e-4 of the largest, without the CPU's transforms or an upload. For GPUs: a
// software OpenGL is slower than the kernels of systems/water.
//
// Reads    OceanState's spectrum
// Writes   displacement and derivatives
// Order    before the water is drawn
// Shaders  ocean_waves.comp, ocean_fields.comp, lib/fft_line.glsl
//
// Two dispatches for all cascades. A line of the transform lies in shared memory: 32 bytes a point,
// so 1024 points are all that OpenGL promises room for.

/// Layer c is cascade c. A texel's center is not its place: texel i is at i * patch / size.
struct OceanFields {
    gpu::Texture displacement;  ///< shift_x, height, shift_z [m]; shift_xz
    gpu::Texture derivatives;   ///< slope_x, slope_z, shift_xx, shift_zz
};

struct OceanFft {
    int size = 0;
    int cascades = 0;
    Vec4 patches = Vec4(1);  ///< sides of the cascades [m]
    const gpu::Program* waves_program = nullptr;
    const gpu::Program* fields_program = nullptr;
    gpu::Buffer waves;        ///< ahead, behind
    gpu::Buffer frequencies;  ///< [rad/s]
    gpu::Buffer lines;        ///< between the two halves
    OceanFields fields;
};

/// Compiles the shaders for the size of `state`, whose cascades are there, and uploads its spectra.
/// To be made again when OceanState::made_for has changed.
[[nodiscard]] Result<OceanFft> create_ocean_fft(gpu::Device& device, const OceanState& state);

struct OceanFieldIds {
    TextureId displacement;
    TextureId derivatives;
};

/// Brings `fft.fields` to `time` [s].
[[nodiscard]] OceanFieldIds
synthesize_ocean(FrameGraph& graph, const OceanFft& fft, float choppiness, double time);

}  // namespace limn
