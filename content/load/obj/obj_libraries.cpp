#include "content/load/obj/obj_libraries.h"

#include "content/load/gltf/gltf_scene.h"
#include "content/load/obj/obj_material.h"
#include "content/load/obj/obj_paths.h"
#include "content/load/obj/obj_textures.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace limn {

namespace {

constexpr std::size_t kMaxLibraries = 256;
constexpr std::size_t kMaxLibraryWords = 16;  // of a statement, which are tried in all ways

std::vector<std::string_view> split_library_words(std::string_view text) {
    constexpr std::string_view kSpaces = " \t";
    std::vector<std::string_view> words;
    std::size_t at = text.find_first_not_of(kSpaces);
    while (at != std::string_view::npos) {
        const std::size_t end = std::min(text.find_first_of(kSpaces, at), text.size());
        words.push_back(text.substr(at, end - at));
        at = text.find_first_not_of(kSpaces, end);
    }
    return words;
}

/// The text from the beginning of one word to the end of another.
std::string_view join_library_words(std::string_view first, std::string_view last) {
    const auto length = static_cast<std::size_t>(last.data() + last.size() - first.data());
    return {first.data(), length};
}

/// "red" of "red # as bricks".
std::string without_obj_comment(const std::string& name) {
    const std::size_t comment = name.find(" #");
    const std::size_t end = name.find_last_not_of(" \t", comment);
    return comment == std::string::npos || end == std::string::npos ? name
                                                                    : name.substr(0, end + 1);
}

/// The materials of all libraries of a file.
class ObjLibraries {
  public:
    ObjLibraries(const std::string& path, const ObjLimits& limits, GltfScene& scene)
        : path_(path), limits_(limits), scene_(scene), folder_(folder_of(path)) {
        folder_ = folder_.empty() ? "." : folder_;
    }

    /// One file name with spaces, or several: at each word, the longest that there is.
    void read_statement(std::string_view statement) {
        std::vector<std::string_view> words = split_library_words(statement);
        words.resize(std::min(words.size(), kMaxLibraryWords));
        for (std::size_t first = 0; first < words.size();) {
            std::size_t last = words.size();
            std::optional<Error> error;
            while (last > first
                   && !read_library(join_library_words(words[first], words[last - 1]), error)) {
                --last;
            }
            if (last > first) {
                first = last;
                continue;
            }
            if (words[first].starts_with('#')) {
                return;
            }
            scene_.warnings.push_back(error->message);
            first = end_of_missing_name(words, first);
        }
    }

    struct Entry {
        ObjMaterial material;
        std::string folder;  ///< of its library
    };
    /// Null where no library has it.
    [[nodiscard]] const Entry* find(const std::string& name) const {
        for (const std::string& key : {name, without_obj_comment(name)}) {
            for (const auto* const entries : {&entries_, &without_comments_}) {
                if (const auto found = entries->find(key); found != entries->end()) {
                    return &found->second;
                }
            }
        }
        return nullptr;
    }
    [[nodiscard]] bool has_read_any() const { return has_read_any_; }

  private:
    /// False with the error of the first name that was tried, where there is no such file.
    bool read_library(std::string_view name, std::optional<Error>& first_error) {
        const Result<ObjFetched> fetched =
            fetch_obj_file(name, folder_, "", path_ + ": mtllib", limits_.max_bytes);
        if (!fetched) {
            first_error = first_error ? first_error : fetched.error();
            return false;
        }
        const std::string_view text(
            reinterpret_cast<const char*>(fetched->bytes.data()), fetched->bytes.size());
        const Result<ObjLibrary> library =
            parse_obj_materials(text, folder_ + "/" + fetched->path, limits_);
        if (!library) {
            scene_.warnings.push_back(library.error().message);
            return true;
        }
        has_read_any_ = true;
        scene_.warnings.insert(
            scene_.warnings.end(), library->warnings.begin(), library->warnings.end());
        for (const ObjMaterial& material : library->materials) {
            const Entry entry{material, folder_of(fetched->path)};
            entries_.try_emplace(material.name, entry);
            without_comments_.try_emplace(without_obj_comment(material.name), entry);
        }
        return true;
    }

    /// Behind the first word that ends a name, from `first` on.
    static std::size_t
    end_of_missing_name(const std::vector<std::string_view>& words, std::size_t first) {
        for (std::size_t i = first; i < words.size(); ++i) {
            if (words[i].ends_with(".mtl")) {
                return i + 1;
            }
        }
        return words.size();
    }

    const std::string& path_;
    const ObjLimits& limits_;
    GltfScene& scene_;
    std::string folder_;
    std::map<std::string, Entry> entries_;
    std::map<std::string, Entry> without_comments_;
    bool has_read_any_ = false;
};

}  // namespace

void build_obj_materials(
    const ObjFile& obj, const std::string& path, const ObjLimits& limits, GltfScene& scene) {
    ObjLibraries libraries(path, limits, scene);
    std::vector<std::string> statements = obj.libraries;
    statements.resize(std::min(statements.size(), kMaxLibraries));
    for (std::size_t i = 0; i < statements.size(); ++i) {
        const auto here = statements.begin() + static_cast<std::ptrdiff_t>(i);
        if (std::find(statements.begin(), here, *here) == here) {
            libraries.read_statement(*here);
        }
    }
    ObjMaterialBuilder builder(scene, folder_of(path).empty() ? "." : folder_of(path), limits);
    for (const std::string& name : obj.materials) {
        const ObjLibraries::Entry* const entry = libraries.find(name);
        Material material;
        if (entry != nullptr) {
            material = builder.build(entry->material, entry->folder);
        } else {
            material = builder.build({}, "");
            material.base_color = obj.colors.empty() ? material.base_color : Vec4(1);
            if (libraries.has_read_any() && !name.empty()) {
                scene.warnings.push_back(format_text(
                    "{}: usemtl: found \"{}\", expected a material of its libraries; it is gray",
                    path, name));
            }
        }
        material.name = name.empty() ? "default" : name;
        scene.materials.push_back(std::move(material));
    }
}

}  // namespace limn
