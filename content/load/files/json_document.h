#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// JSON with comments (// and /* */), parsed into values that keep their source position, so that
// errors can point at them: "levels/pool.level.json:12:20: ...".
//
// Our own parser, because libraries report positions for syntax errors only. RFC 8259 apart from
// the comments: no trailing commas, no NaN, strings are valid UTF-8; keys of an object are unique.
// A number keeps its spelling, for messages and for 64-bit integers that a double cannot hold.
// Depth, size and count are limited, so a malicious file ends in an error.

/// Position in a text; both count from 1, the column in characters. 0 = not from a text.
struct SourcePosition {
    std::uint32_t line = 0;
    std::uint32_t column = 0;
    const std::string* file = nullptr;  ///< of an included file (level_include.h); not owned
};

/// "file:line:column", with the position's own file if it has one; without a line only the file.
[[nodiscard]] std::string location_text(std::string_view file, SourcePosition at);

enum class JsonKind : std::uint8_t { Null, Bool, Number, String, Array, Object };

struct JsonMember;

struct JsonValue {
    JsonKind kind = JsonKind::Null;
    bool truth = false;               ///< of Bool
    SourcePosition at;                ///< of its first character
    double number = 0.0;              ///< of Number, finite
    std::string text;                 ///< of String: decoded UTF-8; of Number: as spelled
    std::vector<JsonValue> items;     ///< of Array
    std::vector<JsonMember> members;  ///< of Object, in file order; unique keys

    /// The member's value, or null when this is not an object or has no such key.
    [[nodiscard]] const JsonValue* find(std::string_view key) const;
    /// The same, with a null value for a member that is missing.
    [[nodiscard]] const JsonValue& operator[](std::string_view key) const;
};

struct JsonMember {
    std::string key;
    SourcePosition at;  ///< of the key
    JsonValue value;
};

/// Limits on untrusted text.
struct JsonLimits {
    std::size_t max_bytes = std::size_t{64} << 20;
    std::size_t max_values = 4'000'000;
    int max_depth = 64;  ///< of nested arrays and objects
};

/// Parses exactly one value. Fails with "file:line:column: found X, expected Y".
[[nodiscard]] Result<JsonValue>
parse_json(std::string_view text, std::string_view file, const JsonLimits& limits = {});

/// Also fails when `path` cannot be read, is not a regular file or is too large.
[[nodiscard]] Result<JsonValue> load_json(const std::string& path, const JsonLimits& limits = {});

/// Text that parse_json reads back to the same value; short arrays and objects on one line.
[[nodiscard]] std::string write_json(const JsonValue& value);

/// Values for write_json. A float is written with the fewest digits that restore it exactly.
[[nodiscard]] JsonValue json_of(bool truth);
[[nodiscard]] JsonValue json_of(float number);
[[nodiscard]] JsonValue json_of(double number);
[[nodiscard]] JsonValue json_of(std::int64_t number);
[[nodiscard]] JsonValue json_of(std::uint64_t number);
[[nodiscard]] JsonValue json_of(std::string_view text);
[[nodiscard]] JsonValue json_array(std::vector<JsonValue> items = {});
[[nodiscard]] JsonValue json_object(std::vector<JsonMember> members = {});

/// Short description for the "found" of a message: `the string "abc"`, `the number 7`, `an object`.
[[nodiscard]] std::string describe(const JsonValue& value);

/// `text` in quotes, escaped and truncated, for messages that show strings from a file.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// " (did you mean Z?)", or "" when no candidate is similar.
[[nodiscard]] std::string
did_you_mean(std::string_view name, std::span<const std::string_view> candidates);

}  // namespace limn
