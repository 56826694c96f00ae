#include "content/load/files/file_uri.h"

#include "content/load/files/atomic_file.h"
#include "content/load/files/json_document.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

namespace limn {

namespace {

int hex_digit(char c) {
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    const char lower = static_cast<char>(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

/// "%20" to " "; nullopt when a % is not followed by two hexadecimal digits.
std::optional<std::string> decode_percent(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            result += text[i];
            continue;
        }
        if (i + 2 >= text.size() || hex_digit(text[i + 1]) < 0 || hex_digit(text[i + 2]) < 0) {
            return std::nullopt;
        }
        result += static_cast<char>(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2]));
        i += 2;
    }
    return result;
}

constexpr std::array<std::int8_t, 256> make_base64_table() {
    std::array<std::int8_t, 256> table{};
    table.fill(-1);
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < kDigits.size(); ++i) {
        table[static_cast<unsigned char>(kDigits[i])] = static_cast<std::int8_t>(i);
    }
    return table;
}

constexpr std::array<std::int8_t, 256> kBase64 = make_base64_table();

std::optional<std::vector<std::byte>> decode_base64(std::string_view text) {
    while (!text.empty() && text.back() == '=') {
        text.remove_suffix(1);
    }
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() * 3 / 4);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const int digit = kBase64[static_cast<unsigned char>(c)];
        if (digit < 0) {
            return std::nullopt;
        }
        bits = (bits << 6) | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes.push_back(static_cast<std::byte>(bits >> count));
        }
    }
    return bytes;
}

/// data:[type][;base64],content (RFC 2397).
Result<std::vector<std::byte>> decode_data_uri(std::string_view uri, const std::string& location) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos) {
        return fail("{}: found {}, expected a comma before the data", location, in_quotes(uri));
    }
    const std::string_view content = uri.substr(comma + 1);
    if (!uri.substr(0, comma).ends_with(";base64")) {
        const std::optional<std::string> text = decode_percent(content);
        if (!text) {
            return fail("{}: found a data: URI with a % without two hexadecimal digits", location);
        }
        const auto bytes = std::as_bytes(std::span(*text));
        return std::vector<std::byte>(bytes.begin(), bytes.end());
    }
    std::optional<std::vector<std::byte>> bytes = decode_base64(content);
    if (!bytes) {
        return fail("{}: found a data: URI with a character that is not base64", location);
    }
    return std::move(*bytes);
}

/// Why `path`, percent-decoded, may not be opened, or "".
std::string_view refusal(const std::string& path) {
    if (path.empty()) {
        return "an empty URI";
    }
    if (path.find('\0') != std::string::npos) {
        return "a zero byte";
    }
    if (path.front() == '/' || path.front() == '\\') {
        return "an absolute path";
    }
    if (path.find(':') != std::string::npos) {
        return "a scheme or a drive";
    }
    if (path.find('\\') != std::string::npos) {
        return "a backslash";
    }
    for (const std::filesystem::path& part : std::filesystem::path(path)) {
        if (part == "..") {
            return "\"..\"";
        }
    }
    return "";
}

bool is_under(const std::filesystem::path& path, const std::filesystem::path& folder) {
    const auto [in_folder, in_path] =
        std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
    return in_folder == folder.end() || in_folder->empty();
}

}  // namespace

Result<std::vector<std::byte>> fetch_uri(
    const std::string& uri, const std::string& folder, const std::string& location,
    std::uint64_t max_bytes) {
    if (uri.starts_with("data:")) {
        return decode_data_uri(uri, location);
    }
    const std::optional<std::string> relative = decode_percent(uri);
    if (!relative) {
        return fail(
            "{}: found {}, expected %XX with two hexadecimal digits", location, in_quotes(uri));
    }
    if (const std::string_view why = refusal(*relative); !why.empty()) {
        return fail(
            "{}: found {} in {}, expected a path under the file's own folder", location, why,
            in_quotes(uri));
    }
    if (folder.empty()) {
        return fail(
            "{}: found {}, expected no references to other files", location, in_quotes(uri));
    }
    std::error_code error;
    const std::filesystem::path base = std::filesystem::canonical(folder, error);
    const std::filesystem::path path = std::filesystem::canonical(base / *relative, error);
    if (error) {
        return fail(
            "{}: {}: no such file in {}{}", location, in_quotes(uri), base.string(),
            file_suggestion((base / *relative).string()));
    }
    if (!is_under(path, base)) {
        return fail(
            "{}: found {}, a link out of the file's folder, expected a file under it", location,
            in_quotes(uri));
    }
    Result<std::vector<std::byte>> bytes = read_file(path.string(), max_bytes);
    if (!bytes) {
        return fail("{}: {}", location, bytes.error().message);
    }
    return bytes;
}

}  // namespace limn
