#pragma once

#include "ecs/components/ocean.h"
#include "render/gpu/buffer.h"
#include "render/gpu/device.h"
#include "render/graph/frame_graph.h"

namespace limn {

// The fields of an ocean synthesized on the GPU from the simulation's spectrum: equal to those of
// OceanState to 1e-4 of the maximum, without the CPU's FFT or an upload. For GPUs: a software
// OpenGL is slower than the kernels of systems/water.
//
// Reads    OceanState's spectrum
// Writes   displacement and derivatives
// Order    before the water is drawn
// Shaders  ocean_waves.comp, ocean_fields.comp, lib/fft_line.glsl
//
// Two dispatches for all cascades. A line of the FFT lies in shared memory: 32 bytes per point, so
// 1024 points are the maximum that OpenGL guarantees.

/// Layer c is cascade c. Samples are at texel corners, not centers: texel i is at i * patch / size.
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
    gpu::Buffer waves;        ///< forward and backward wave amplitudes (ahead, behind)
    gpu::Buffer frequencies;  ///< [rad/s]
    gpu::Buffer lines;        ///< intermediate result between the two dispatches
    OceanFields fields;
};

/// Compiles the shaders for the size of `state`, which must have cascades, and uploads its spectra.
/// Must be recreated when OceanState::made_for changes.
[[nodiscard]] Result<OceanFft> create_ocean_fft(gpu::Device& device, const OceanState& state);

struct OceanFieldIds {
    TextureId displacement;
    TextureId derivatives;
};

/// Evaluates `fft.fields` at `time` [s].
[[nodiscard]] OceanFieldIds
synthesize_ocean(FrameGraph& graph, const OceanFft& fft, float choppiness, double time);

}  // namespace limn
