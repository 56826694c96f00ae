#include "content/load/obj/obj_paths.h"

#include "content/load/files/file_uri.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>
#include <system_error>

namespace limn {

namespace {

/// A name as a URI.
std::string escape_percent(std::string_view name) {
    std::string uri;
    for (const char c : name) {
        uri += c == '%' ? std::string("%25") : std::string(1, c);
    }
    return uri;
}

std::string without_obj_folders(const std::string& name) {
    return name.substr(name.find_last_of("/\\:") + 1);
}

bool is_same_letter(char a, char b) {
    return std::tolower(static_cast<unsigned char>(a))
           == std::tolower(static_cast<unsigned char>(b));
}

/// The file of `folder` with this name in any case.
std::string find_any_case(const std::filesystem::path& folder, const std::string& name) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        const std::string found = entry.path().filename().string();
        if (std::equal(found.begin(), found.end(), name.begin(), name.end(), is_same_letter)) {
            return found;
        }
    }
    return "";
}

/// Some programs put names in quotes.
std::string_view without_quotes(std::string_view name) {
    const bool has_quotes = name.size() > 2 && name.starts_with('"') && name.ends_with('"');
    return has_quotes ? name.substr(1, name.size() - 2) : name;
}

/// What a name may stand for, as URIs.
std::vector<std::string> obj_uris_of(std::string_view name) {
    name = without_quotes(name);
    std::string slashes(name);
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    const std::string last = without_obj_folders(slashes);
    std::vector<std::string> uris = {escape_percent(name)};
    for (const std::string& uri : {escape_percent(slashes), slashes, escape_percent(last), last}) {
        if (std::find(uris.begin(), uris.end(), uri) == uris.end()) {
            uris.push_back(uri);
        }
    }
    return uris;
}

}  // namespace

std::string folder_of(const std::string& path) {
    return std::filesystem::path(path).parent_path().string();
}

Result<ObjFetched> fetch_obj_file(
    std::string_view name, const std::string& folder, const std::string& subfolder,
    const std::string& position, std::uint64_t max_bytes) {
    std::optional<Error> first_error;
    std::vector<std::string> subfolders = {subfolder};
    if (!subfolder.empty()) {
        subfolders.emplace_back();
    }
    const auto fetch = [&](const std::string& in, const std::string& uri) -> Result<ObjFetched> {
        const std::string path = in.empty() ? uri : escape_percent(in) + "/" + uri;
        Result<std::vector<std::byte>> bytes = fetch_uri(path, folder, position, max_bytes);
        if (bytes) {
            return ObjFetched{in.empty() ? uri : in + "/" + uri, *std::move(bytes)};
        }
        if (!first_error) {
            first_error = bytes.error();
        }
        return bytes.error();
    };
    for (const std::string& uri : obj_uris_of(name)) {
        for (const std::string& in : subfolders) {
            if (Result<ObjFetched> found = fetch(in, uri)) {
                return found;
            }
        }
    }
    for (const std::string& in : subfolders) {
        const std::string found = find_any_case(
            std::filesystem::path(folder) / in,
            without_obj_folders(std::string(without_quotes(name))));
        if (!found.empty()) {
            if (Result<ObjFetched> file = fetch(in, escape_percent(found))) {
                return file;
            }
        }
    }
    return *first_error;
}

}  // namespace limn
