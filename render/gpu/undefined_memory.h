#pragma once

namespace limn::gpu {

/// Whether new buffers and textures are filled with NaN (formats without it: 1), so that reads of
/// uninitialized memory show on every machine, not only on some GPU: LIMN_UNDEFINED=nan in the
/// environment, as in the tests of render/.
[[nodiscard]] bool fills_undefined_memory();

}  // namespace limn::gpu
