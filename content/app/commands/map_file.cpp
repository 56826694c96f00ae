#include "content/app/commands/map_file.h"

#include "content/app/commands/image_file.h"
#include "content/load/files/exr_file.h"
#include "content/load/files/png_file.h"
#include "ecs/base/check.h"

#include <string_view>
#include <vector>

namespace limn {

Status write_map(const std::string& path, const BakedMap& map, int channels, int bits) {
    LIMN_CHECK(channels == 1 || channels == 3 || channels == 4);
    if (LIMN_TRY(image_file_kind(path)) == ImageFileKind::Png) {
        return bits > 8
                   ? write_png16(path, map.width, map.height, channels, map_words(map, channels))
                   : write_png(path, map.width, map.height, channels, map_bytes(map, channels));
    }
    std::vector<float> values;
    for (const Vec4& texel : map.texels) {
        for (int c = 0; c < channels; ++c) {
            values.push_back(texel[c]);
        }
    }
    ExrImage image = {.width = map.width, .height = map.height};
    const std::string_view letters = channels == 1 ? "Y" : channels == 3 ? "RGB" : "RGBA";
    add_layer(image, "", letters, values, false);
    return write_exr(path, image);
}

std::string with_ending(const std::string& path, const std::string& ending) {
    const std::size_t dot = path.rfind('.');
    return path.substr(0, dot) + "_" + ending + path.substr(dot);
}

}  // namespace limn
