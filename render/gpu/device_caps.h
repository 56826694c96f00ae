#pragma once

#include "ecs/base/result.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace limn::gpu {

// Capabilities of the device, queried once, and whether a pass fits them (shade.profile). Three
// classes of error, all found before anything is drawn: a capability is absent, the context lacks
// something mandatory, or a capacity is exceeded.

/// Choice of formats and shader definitions: those of a GPU, or those that are fast where the CPU
/// renders. Either runs on any OpenGL; the images agree to 45 dB.
enum class Profile : std::uint8_t { Gpu, Software };

struct DeviceCaps {
    std::string vendor;
    std::string renderer;
    std::string version;
    int gl_major = 0;
    int gl_minor = 0;
    bool software = false;           ///< rendered by the CPU: llvmpipe, softpipe, SwiftShader
    Profile profile = Profile::Gpu;  ///< by `software`, unless requested
    bool debug = false;              ///< a debug context
    /// zink on lavapipe (Mesa 22.3.6), which compiles in uniforms that conditions and loop bounds
    /// read at a constant offset of a block. lvp_inline_uniforms.c indexes its table of such
    /// offsets with the wrong stride: from the third block of a stage on it writes past the end,
    /// which gives wrong code or a crash in update_inline_shader_state(). Programs then get the
    /// definition OPAQUE_UNIFORMS, which hides the offsets from the compiler.
    bool opaque_uniforms = false;

    int max_texture_size = 0;  ///< of a side [px]
    int max_texture_3d_size = 0;
    int max_cube_size = 0;
    int max_texture_layers = 0;
    int max_samples = 0;
    int max_color_attachments = 0;    ///< per pass
    int max_vertex_textures = 0;      ///< texture units of the stage
    int max_evaluation_textures = 0;  ///< of tessellation; 0: there is none
    int max_fragment_textures = 0;
    int max_compute_textures = 0;
    int max_combined_textures = 0;  ///< texture units of all stages together
    int max_image_units = 0;
    int max_uniform_block_bytes = 0;
    int max_uniform_bindings = 0;
    int max_storage_bindings = 0;
    std::int64_t max_storage_bytes = 0;  ///< of one block
    int max_vertex_storage_blocks = 0;
    int max_fragment_storage_blocks = 0;
    int max_compute_invocations = 0;  ///< of one work group
    int max_compute_shared_bytes = 0;
    int uniform_alignment = 256;  ///< of an offset in a buffer [bytes]
    int storage_alignment = 256;
    float max_anisotropy = 1;
    bool depth_bounds = false;  ///< GL_EXT_depth_bounds_test
};

/// Queries the current context.
[[nodiscard]] DeviceCaps read_device_caps();

/// Minimum limits that a pass requires; 0 = no requirement.
struct PassRequirements {
    int vertex_textures = 0;
    int evaluation_textures = 0;
    int fragment_textures = 0;
    int compute_textures = 0;
    int color_attachments = 0;
    int texture_size = 0;
    int texture_layers = 0;
    int samples = 0;
    int image_units = 0;
    int uniform_block_bytes = 0;
    int vertex_storage_blocks = 0;
    int fragment_storage_blocks = 0;
    int compute_invocations = 0;
    int compute_shared_bytes = 0;
};

enum class ProfileErrorKind {
    Capability,  ///< the feature is absent: its limit is 0
    Context,     ///< something mandatory is missing, e.g. a vertex stage that writes no position
    Capacity,    ///< the feature exists, but its limit is exceeded
};

struct ProfileError {
    ProfileErrorKind kind;
    std::string message;  ///< "capacity: 40 fragment textures required, this device has 32"
};

/// Every requirement in `needs` that `caps` does not meet; empty if all are met.
[[nodiscard]] std::vector<ProfileError>
check_requirements(const DeviceCaps& caps, const PassRequirements& needs);

/// check_requirements as one line that begins with `pass`.
[[nodiscard]] Status
require(const DeviceCaps& caps, const char* pass, const PassRequirements& needs);

/// Index of the first of `versions` (most capable first) that fits, or -1.
[[nodiscard]] int
choose_version(const DeviceCaps& caps, std::span<const PassRequirements> versions);

}  // namespace limn::gpu
