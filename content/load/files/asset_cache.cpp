#include "content/load/files/asset_cache.h"

#include "content/load/files/atomic_file.h"
#include "ecs/base/hash.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <span>
#include <type_traits>
#include <vector>

namespace limn {
namespace {

namespace fs = std::filesystem;

template <typename T>
constexpr bool is_plain = std::is_trivially_copyable_v<T>;

/// Serializes its arguments.
class Writer {
  public:
    template <typename T>
    requires is_plain<T>
    void operator()(const T& value) { append(&value, sizeof value); }
    void operator()(const std::string& text) { append_all(text); }
    template <typename T>
    void operator()(const std::vector<T>& values) {
        if constexpr (is_plain<T>) {
            append_all(values);
        } else {
            (*this)(std::uint64_t{values.size()});
            for (const T& value : values) {
                visit(*this, value);
            }
        }
    }
    std::vector<std::byte> bytes;

  private:
    template <typename List>
    void append_all(const List& list) {
        (*this)(std::uint64_t{list.size()});
        append(list.data(), list.size() * sizeof(*list.data()));
    }
    void append(const void* data, std::size_t size) {
        const auto* const first = static_cast<const std::byte*>(data);
        bytes.insert(bytes.end(), first, first + size);
    }
};

/// Deserializes its arguments in the same order; `ok` becomes false if bytes run out.
class CacheReader {
  public:
    explicit CacheReader(std::span<const std::byte> bytes) : left_(bytes) {}

    template <typename T>
    requires is_plain<T>
    void operator()(T& value) { take(&value, 1); }
    void operator()(std::string& text) { take_all(text); }
    template <typename T>
    void operator()(std::vector<T>& values) {
        if constexpr (is_plain<T>) {
            take_all(values);
        } else {
            for (std::uint64_t i = count(1); i > 0 && ok; --i) {
                visit(*this, values.emplace_back());
            }
        }
    }
    [[nodiscard]] bool at_end() const { return ok && left_.empty(); }
    bool ok = true;

  private:
    /// A count of values of at least `size` bytes each.
    std::uint64_t count(std::size_t size) {
        std::uint64_t found = 0;
        (*this)(found);
        ok = ok && found <= left_.size() / size;
        return ok ? found : 0;
    }
    template <typename List>
    void take_all(List& list) {
        list.resize(count(sizeof(*list.data())));
        take(list.data(), list.size());
    }
    template <typename T>
    void take(T* to, std::size_t values) {
        const std::size_t size = values * sizeof(T);
        ok = ok && size <= left_.size();
        if (ok && size > 0) {
            std::memcpy(to, left_.data(), size);
            left_ = left_.subspan(size);
        }
    }
    std::span<const std::byte> left_;
};

// Structured bindings name all members, so that a new member does not compile until it is
// serialized.

template <typename Archive, typename Image>
void visit_image(Archive& archive, Image& image) {
    auto& [name, width, height, format, srgb, mip_levels, pixels, version] = image;
    archive(name);
    archive(width);
    archive(height);
    archive(format);
    archive(srgb);
    archive(mip_levels);
    archive(pixels);
    archive(version);
}

template <typename Archive, typename Maps>
void visit_maps(Archive& archive, Maps& maps) {
    auto& [base_color, normal, orm, motion, positive_light, negative_light, relief] = maps;
    for (auto* image :
         {&base_color, &normal, &orm, &motion, &positive_light, &negative_light, &relief}) {
        visit_image(archive, *image);
    }
}

template <typename Archive, typename Morph>
requires std::is_same_v<std::remove_const_t<Morph>, MorphTarget>
void visit(Archive& archive, Morph& morph) {
    auto& [name, action_unit, vertices, positions, normals, tangents, drivers] = morph;
    archive(name);
    archive(action_unit);
    archive(vertices);
    archive(positions);
    archive(normals);
    archive(tangents);
    archive(drivers);
}

template <typename Archive, typename Region>
requires std::is_same_v<std::remove_const_t<Region>, VertexRegion>
void visit(Archive& archive, Region& region) {
    auto& [name, weights, across] = region;
    archive(name);
    archive(weights);
    archive(across);
}

template <typename Archive, typename Mesh>
void visit_mesh(Archive& archive, Mesh& mesh) {
    auto& [name, positions, normals, tangents, uvs, uvs1, colors, indices, skin, morphs, pieces, regions, bounds, version] =
        mesh;
    auto& [first, joints, weights] = skin;
    archive(name);
    archive(positions);
    archive(normals);
    archive(tangents);
    archive(uvs);
    archive(uvs1);
    archive(colors);
    archive(indices);
    archive(first);
    archive(joints);
    archive(weights);
    archive(morphs);
    archive(pieces);
    archive(regions);
    archive(bounds);
    archive(version);
}

std::string cache_path(const std::string& folder, std::string_view key) {
    return fmt::format("{}/{:016x}.asset", folder, hash_text(key, hash_text(generators_hash())));
}

/// Removes the least recently used files until the rest fits.
void prune(const std::string& folder, std::uint64_t max_bytes) {
    struct File {
        fs::file_time_type used;
        std::uint64_t size;
        fs::path path;
    };
    std::vector<File> files;
    std::uint64_t total = 0;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
        if (entry.path().extension() == ".asset") {
            const std::uint64_t size = entry.file_size(error);
            total += error ? 0 : size;
            files.push_back({entry.last_write_time(error), error ? 0 : size, entry.path()});
        }
    }
    std::sort(
        files.begin(), files.end(), [](const File& a, const File& b) { return a.used < b.used; });
    for (auto file = files.begin(); file != files.end() && total > max_bytes; ++file) {
        total -= fs::remove(file->path, error) ? file->size : 0;
    }
}

/// File format: hash of the rest, hash of the generators, key, asset.
template <typename T>
void write_asset(
    const std::string& folder, std::uint64_t max_bytes, std::string_view key, const T& asset,
    void (*visit_asset)(Writer&, const T&)) {
    std::error_code error;
    if (folder.empty() || (fs::create_directories(folder, error), error)) {
        return;
    }
    Writer writer;
    writer(std::uint64_t{0});
    writer(std::string(generators_hash()));
    writer(std::string(key));
    visit_asset(writer, asset);
    const std::uint64_t hash = hash_bytes(std::span(writer.bytes).subspan(sizeof(std::uint64_t)));
    std::memcpy(writer.bytes.data(), &hash, sizeof hash);
    if (write_file(cache_path(folder, key), writer.bytes)) {
        prune(folder, max_bytes);
    }
}

template <typename T>
std::optional<T>
read_asset(const std::string& folder, std::string_view key, void (*visit_asset)(CacheReader&, T&)) {
    if (folder.empty()) {
        return std::nullopt;
    }
    const std::string path = cache_path(folder, key);
    std::error_code error;
    if (!fs::exists(path, error)) {
        return std::nullopt;
    }
    const auto bytes = read_file(path);
    if (!bytes || bytes->size() < sizeof(std::uint64_t)) {
        return std::nullopt;
    }
    const std::span<const std::byte> all = std::as_bytes(std::span(*bytes));
    CacheReader reader(all);
    std::uint64_t hash = 0;
    std::string generators;
    std::string found;
    reader(hash);
    if (hash != hash_bytes(all.subspan(sizeof hash))) {
        return std::nullopt;
    }
    reader(generators);
    reader(found);
    T asset;
    if (generators != generators_hash() || found != key) {
        return std::nullopt;
    }
    visit_asset(reader, asset);
    if (!reader.at_end()) {
        return std::nullopt;
    }
    fs::last_write_time(path, fs::file_time_type::clock::now(), error);
    return asset;
}

std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value != nullptr ? value : "";
}

}  // namespace

AssetCache AssetCache::of_user() {
    if (const std::string chosen = variable("LIMN_CACHE"); !chosen.empty()) {
        return AssetCache(chosen == "off" ? std::string() : chosen);
    }
    if (const std::string cache = variable("XDG_CACHE_HOME"); !cache.empty()) {
        return AssetCache(cache + "/limn");
    }
    const std::string home = variable("HOME");
    return AssetCache(home.empty() ? std::string() : home + "/.cache/limn");
}

std::optional<PatternMaps> AssetCache::find_pattern(std::string_view key) const {
    return read_asset<PatternMaps>(folder_, key, visit_maps<CacheReader, PatternMaps>);
}

std::optional<MeshData> AssetCache::find_mesh(std::string_view key) const {
    return read_asset<MeshData>(folder_, key, visit_mesh<CacheReader, MeshData>);
}

std::optional<ImageData> AssetCache::find_image(std::string_view key) const {
    return read_asset<ImageData>(folder_, key, visit_image<CacheReader, ImageData>);
}

void AssetCache::keep(std::string_view key, const PatternMaps& maps) const {
    write_asset(folder_, max_bytes_, key, maps, visit_maps<Writer, const PatternMaps>);
}

void AssetCache::keep(std::string_view key, const MeshData& mesh) const {
    write_asset(folder_, max_bytes_, key, mesh, visit_mesh<Writer, const MeshData>);
}

void AssetCache::keep(std::string_view key, const ImageData& image) const {
    write_asset(folder_, max_bytes_, key, image, visit_image<Writer, const ImageData>);
}

}  // namespace limn
