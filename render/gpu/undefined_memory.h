#pragma once

namespace limn::gpu {

/// Whether new buffers and textures are filled with NaN (formats without it: 1), so that reading
/// what nobody has written shows here, too, and not only on some GPU: LIMN_UNDEFINED=nan in the
/// environment, as in the tests of render/.
[[nodiscard]] bool fills_undefined_memory();

}  // namespace limn::gpu
