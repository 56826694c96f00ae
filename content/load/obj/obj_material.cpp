#include "content/load/obj/obj_material.h"

#include "content/load/obj/obj_lines.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <exception>
#include <utility>

namespace limn {

namespace {

/// An image statement in lower case, and where it goes; null: ignored with a warning.
struct ObjMapKeyword {
    std::string_view keyword;
    ObjMap ObjMaterial::*map;
};

constexpr ObjMapKeyword kObjMaps[] = {
    {"map_kd", &ObjMaterial::diffuse_map},
    {"map_ke", &ObjMaterial::emission_map},
    {"map_d", &ObjMaterial::opacity_map},
    {"map_ns", &ObjMaterial::shininess_map},
    {"map_pr", &ObjMaterial::roughness_map},
    {"map_pm", &ObjMaterial::metalness_map},
    {"bump", &ObjMaterial::relief_map},
    {"map_bump", &ObjMaterial::relief_map},
    {"norm", &ObjMaterial::normal_map},
    {"map_norm", &ObjMaterial::normal_map},
    {"map_kn", &ObjMaterial::normal_map},
    {"map_ks", nullptr},
    {"map_tr", nullptr},
    {"map_tf", nullptr},
    {"map_ps", nullptr},
    {"map_pc", nullptr},
    {"map_pcr", nullptr},
    {"map_rma", nullptr},
    {"map_orm", nullptr},
    {"disp", nullptr},
    {"map_disp", nullptr},
    {"decal", nullptr},
    {"refl", nullptr},
    {"map_refl", nullptr},
};

/// An option of an image statement that is not read, with its number of arguments.
struct ObjMapOption {
    std::string_view name;
    int arguments;
};

constexpr ObjMapOption kSkippedOptions[] = {
    {"-blendu", 1}, {"-blendv", 1}, {"-boost", 1}, {"-mm", 2},
    {"-texres", 1}, {"-type", 1},   {"-cc", 1},    {"-colorspace", 1},
};

std::string lower_obj_keyword(std::string_view text) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    return lower;
}

const ObjMapKeyword* find_map_keyword(std::string_view keyword) {
    const std::string lower = lower_obj_keyword(keyword);
    const auto* const found =
        std::find_if(std::begin(kObjMaps), std::end(kObjMaps), [&](const ObjMapKeyword& candidate) {
            return candidate.keyword == lower;
        });
    return found == std::end(kObjMaps) ? nullptr : found;
}

class ObjMaterialReader {
  public:
    ObjMaterialReader(std::string_view text, const std::string& file, const ObjLimits& limits)
        : line_(text, file), file_(file), limits_(limits) {}

    Result<ObjLibrary> read() {
        while (line_.next()) {
            const std::string_view keyword = line_.word();
            if (keyword == "newmtl") {
                if (result_.materials.size() >= limits_.max_names) {
                    return fail(
                        "{}: found more materials, expected at most {}", line_.position(),
                        limits_.max_names);
                }
                result_.materials.emplace_back().name = line_.rest();
            } else if (!result_.materials.empty()) {
                read_statement(keyword, result_.materials.back());
            }
        }
        warnings_.finish(file_);
        return std::move(result_);
    }

  private:
    void read_statement(std::string_view keyword, ObjMaterial& material) {
        if (keyword == "Kd") {
            keep(read_color(keyword, 1), material.diffuse);
        } else if (keyword == "Ke") {
            keep(read_color(keyword, 1e6f), material.emission);
        } else if (keyword == "Ns") {
            keep(read_value(keyword, 1000), material.shininess);
        } else if (keyword == "Pr") {
            keep(read_value(keyword, 1), material.roughness);
        } else if (keyword == "Pm") {
            keep(read_value(keyword, 1), material.metalness);
        } else if (keyword == "d" || keyword == "Tr") {
            read_opacity(keyword, material);
        } else if (const ObjMapKeyword* const map = find_map_keyword(keyword)) {
            read_map(keyword, map->map, material);
        }
    }

    /// A bad value leaves a warning and what was there.
    template <typename Value, typename Target>
    void keep(const Result<Value>& value, Target& target) {
        if (value) {
            target = *value;
        } else {
            warnings_.add(format_text("{}; the value is left out", value.error().message));
        }
    }

    Result<float> read_value(std::string_view keyword, float max) {
        const auto value = static_cast<float>(LIMN_TRY(line_.number(keyword)));
        if (value < 0) {
            return fail(
                "{}: {}: found {}, expected 0 to {}", line_.position(), keyword, value, max);
        }
        constexpr float kRounding = 1e-5f;
        if (value > max * (1 + kRounding)) {
            warnings_.add(format_text(
                "{}: {}: found {}, expected 0 to {}; {} is used", line_.position(), keyword, value,
                max, max));
        }
        return std::min(value, max);
    }

    /// One number is gray.
    Result<Vec3> read_color(std::string_view keyword, float max) {
        Vec3 color(LIMN_TRY(read_value(keyword, max)));
        for (int i = 1; i < 3 && line_.has_word(); ++i) {
            color[i] = LIMN_TRY(read_value(keyword, max));
        }
        return color;
    }

    /// Of both, d counts: some programs write Tr as if it were d.
    void read_opacity(std::string_view keyword, ObjMaterial& material) {
        if (keyword == "d" && !line_.is_number_next()) {
            const std::string_view option = line_.word();
            if (option != "-halo") {
                warnings_.add(format_text(
                    "{}: d: found {}, expected 0 to 1; the value is left out", line_.position(),
                    found_word(option)));
                return;
            }
        }
        if (keyword == "d") {
            keep(read_value(keyword, 1), material.opacity);
            has_dissolve_ = &material - result_.materials.data();
        } else if (has_dissolve_ != &material - result_.materials.data()) {
            Result<float> value = read_value(keyword, 1);
            if (value) {
                *value = 1 - *value;
            }
            keep(value, material.opacity);
        }
    }

    void read_map(std::string_view keyword, ObjMap ObjMaterial::*target, ObjMaterial& material) {
        ObjMap map;
        map.position = format_text("{}: {}", line_.position(), keyword);
        if (target == nullptr) {
            warnings_.add(format_text("{}: the image is ignored", map.position));
            return;
        }
        while (read_option(map)) {  // one after the other
        }
        map.file = line_.rest();
        if (map.file.empty()) {
            warnings_.add(format_text("{}: found no file name, expected one", map.position));
            return;
        }
        material.*target = std::move(map);
    }

    /// False where the next word is none.
    bool read_option(ObjMap& map) {
        const std::string_view option = line_.peek();
        if (option == "-o" || option == "-s" || option == "-t") {
            line_.word();
            Vec3 value = option == "-s" ? Vec3(1) : Vec3(0);
            for (int i = 0; i < 3 && line_.is_number_next(); ++i) {
                value[i] = static_cast<float>(*line_.number(option));
            }
            (option == "-s" ? map.scale : option == "-o" ? map.offset : turbulence_) = Vec2(value);
            return true;
        }
        if (option == "-bm") {
            line_.word();
            if (line_.is_number_next()) {
                map.strength = static_cast<float>(*line_.number(option));
            }
            return true;
        }
        if (option == "-clamp") {
            line_.word();
            map.clamp = line_.word() == "on";
            return true;
        }
        if (option == "-imfchan") {
            line_.word();
            map.channel = channel_of(line_.word());
            return true;
        }
        for (const ObjMapOption& skipped : kSkippedOptions) {
            if (option == skipped.name) {
                for (int i = 0; i <= skipped.arguments; ++i) {
                    line_.word();
                }
                return true;
            }
        }
        return false;
    }

    static ObjChannel channel_of(std::string_view letter) {
        constexpr std::pair<std::string_view, ObjChannel> kChannels[] = {
            {"r", ObjChannel::Red},   {"g", ObjChannel::Green},     {"b", ObjChannel::Blue},
            {"m", ObjChannel::Alpha}, {"l", ObjChannel::Luminance},
        };
        for (const auto& [name, channel] : kChannels) {
            if (name == letter) {
                return channel;
            }
        }
        return ObjChannel::Default;
    }

    ObjLines line_;
    const std::string& file_;
    const ObjLimits& limits_;
    ObjLibrary result_;
    ObjWarnings warnings_{result_.warnings};
    std::ptrdiff_t has_dissolve_ = -1;  ///< index of the last material with a `d`
    Vec2 turbulence_ = {0, 0};          ///< of -t, not read
};

}  // namespace

Result<ObjLibrary>
parse_obj_materials(std::string_view text, const std::string& file, const ObjLimits& limits) {
    LIMN_TRY(check_encoding(text, file));
    try {
        return ObjMaterialReader(text, file, limits).read();
    } catch (const std::exception& exception) {  // out of memory
        return fail("{}: cannot be loaded: {}", file, exception.what());
    }
}

}  // namespace limn
