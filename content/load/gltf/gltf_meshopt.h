#pragma once

#include "content/load/gltf/gltf_document.h"
#include "ecs/base/result.h"

namespace limn {

/// Decodes the buffer views of EXT_meshopt_compression into `document.decoded_views`, which
/// view_bytes prefers. Fails on a stream that is broken, and on sizes that do not fit its mode.
[[nodiscard]] Status decode_meshopt_views(GltfDocument& document);

}  // namespace limn
