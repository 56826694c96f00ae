#include "content/load/files/json_document.h"

#include "content/load/files/atomic_file.h"
#include "ecs/base/text.h"
#include "ecs/base/type_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <unordered_set>

namespace limn {

namespace {

constexpr std::size_t kQuotedBytes = 48;  // of a string, in messages
constexpr std::size_t kLineWidth = 96;    // write_json breaks longer values

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}
bool is_continuation(char c) {
    return (static_cast<unsigned char>(c) & 0xc0) == 0x80;
}

/// Bytes of the UTF-8 character at the start of `text`, or 0 when it is malformed (overlong forms,
/// surrogates and values above U+10FFFF are).
std::size_t utf8_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(0);
    if (first < 0x80) {
        return 1;
    }
    const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    if (first < 0xc2 || first > 0xf4 || text.size() < length) {
        return 0;
    }
    for (std::size_t i = 1; i < length; ++i) {
        if (!is_continuation(text[i])) {
            return 0;
        }
    }
    const unsigned char second = byte(1);
    const bool bad = (first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f)
                     || (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f);
    return bad ? 0 : length;
}

void append_utf8(std::string& out, std::uint32_t code) {
    const auto put = [&](std::uint32_t byte) { out.push_back(static_cast<char>(byte)); };
    if (code < 0x80) {
        put(code);
    } else if (code < 0x800) {
        put(0xc0 | (code >> 6));
        put(0x80 | (code & 0x3f));
    } else if (code < 0x10000) {
        put(0xe0 | (code >> 12));
        put(0x80 | ((code >> 6) & 0x3f));
        put(0x80 | (code & 0x3f));
    } else {
        put(0xf0 | (code >> 18));
        put(0x80 | ((code >> 12) & 0x3f));
        put(0x80 | ((code >> 6) & 0x3f));
        put(0x80 | (code & 0x3f));
    }
}

/// Recursive descent over the text; recursion is bounded by JsonLimits::max_depth. Every function
/// returns false once error_ is set.
class JsonParser {
  public:
    JsonParser(std::string_view text, std::string_view file, const JsonLimits& limits)
        : text_(text), file_(file), limits_(limits) {}

    Result<JsonValue> parse() {
        if (text_.size() > limits_.max_bytes) {
            return fail(
                "{}: found {} bytes, expected at most {}", file_, text_.size(), limits_.max_bytes);
        }
        if (text_.starts_with("\xef\xbb\xbf")) {
            next_ = counted_ = 3;
        }
        JsonValue root;
        if (!skip_blank() || !parse_value(root, 0) || !skip_blank()) {
            return error_;
        }
        if (!at_end()) {
            (void)refuse("the end of the file after the value");
            return error_;
        }
        return root;
    }

  private:
    [[nodiscard]] bool at_end() const { return next_ == text_.size(); }
    [[nodiscard]] char peek() const { return at_end() ? '\0' : text_[next_]; }

    /// Position of next_. Counts each character once, however long the lines are.
    [[nodiscard]] SourcePosition position() {
        const std::string_view passed = text_.substr(counted_, next_ - counted_);
        column_ += static_cast<std::uint32_t>(std::count_if(
            passed.begin(), passed.end(), [](char c) { return !is_continuation(c); }));
        counted_ = next_;
        return {line_, column_};
    }

    bool refuse_at(SourcePosition at, std::string_view found, std::string_view expected) {
        error_ =
            fail("{}:{}:{}: found {}, expected {}", file_, at.line, at.column, found, expected);
        return false;
    }

    /// Error: found the character at next_.
    bool refuse(std::string_view expected) {
        if (at_end()) {
            return refuse_at(position(), "the end of the file", expected);
        }
        const std::size_t length = std::max<std::size_t>(utf8_length(text_.substr(next_)), 1);
        return refuse_at(position(), in_quotes(text_.substr(next_, length)), expected);
    }

    void next_line() {
        ++line_;
        column_ = 1;
        counted_ = next_;
    }

    /// White space and comments.
    bool skip_blank() {
        while (!at_end()) {
            const char c = peek();
            if (c == '\n') {
                ++next_;
                next_line();
            } else if (c == ' ' || c == '\t' || c == '\r') {
                ++next_;
            } else if (c == '/') {
                if (!skip_comment()) {
                    return false;
                }
            } else {
                break;
            }
        }
        return true;
    }

    bool skip_comment() {
        const SourcePosition start = position();
        const std::string_view opening = text_.substr(next_, 2);
        if (opening == "//") {
            next_ = std::min(text_.find('\n', next_), text_.size());
            return true;
        }
        if (opening != "/*") {
            return refuse("a value or a comment");
        }
        const std::size_t end = text_.find("*/", next_ + 2);
        if (end == std::string_view::npos) {
            return refuse_at(start, "an unterminated comment", "*/");
        }
        while (next_ < end) {
            if (text_[next_++] == '\n') {
                next_line();
            }
        }
        next_ = end + 2;
        return true;
    }

    bool parse_value(JsonValue& value, int depth) {
        value.at = position();
        if (++values_ > limits_.max_values) {
            return refuse_at(
                value.at, fmt::format("more than {} values", limits_.max_values), "a smaller file");
        }
        switch (peek()) {
        case '{':
            return check_depth(value, depth) && parse_object(value, depth);
        case '[':
            return check_depth(value, depth) && parse_array(value, depth);
        case '"':
            value.kind = JsonKind::String;
            return parse_string(value.text);
        case 't':
            value.truth = true;
            return parse_word("true", JsonKind::Bool, value);
        case 'f':
            return parse_word("false", JsonKind::Bool, value);
        case 'n':
            return parse_word("null", JsonKind::Null, value);
        default:
            return peek() == '-' || is_digit(peek()) ? parse_number(value) : refuse("a value");
        }
    }

    bool check_depth(const JsonValue& value, int depth) {
        return depth < limits_.max_depth
               || refuse_at(
                   value.at, fmt::format("more than {} levels of nesting", limits_.max_depth),
                   "fewer");
    }

    bool parse_word(std::string_view word, JsonKind kind, JsonValue& value) {
        if (text_.substr(next_, word.size()) != word) {
            return refuse("a value");
        }
        next_ += word.size();
        value.kind = kind;
        return true;
    }

    bool skip_digits() {
        if (!is_digit(peek())) {
            return refuse("a digit");
        }
        while (is_digit(peek())) {
            ++next_;
        }
        return true;
    }

    bool parse_number(JsonValue& value) {
        const std::size_t start = next_;
        if (peek() == '-') {
            ++next_;
        }
        if (peek() == '0') {
            ++next_;
            if (is_digit(peek())) {
                return refuse("no digit after a leading zero");
            }
        } else if (!skip_digits()) {
            return false;
        }
        if (peek() == '.') {
            ++next_;
            if (!skip_digits()) {
                return false;
            }
        }
        if (peek() == 'e' || peek() == 'E') {
            ++next_;
            if (peek() == '+' || peek() == '-') {
                ++next_;
            }
            if (!skip_digits()) {
                return false;
            }
        }
        value.kind = JsonKind::Number;
        value.text = text_.substr(start, next_ - start);
        const char* const end = value.text.data() + value.text.size();
        const std::from_chars_result parsed = std::from_chars(value.text.data(), end, value.number);
        if (parsed.ec != std::errc() || !std::isfinite(value.number)) {
            return refuse_at(
                value.at, "the number " + value.text.substr(0, kQuotedBytes),
                "one that a double can hold");
        }
        return true;
    }

    bool parse_string(std::string& out) {
        const SourcePosition start = position();
        ++next_;
        while (peek() != '"' || at_end()) {
            if (at_end() || peek() == '\n') {
                return refuse_at(start, "an unterminated string", "a closing \"");
            }
            if (peek() == '\\') {
                if (!parse_escape(out)) {
                    return false;
                }
                continue;
            }
            if (static_cast<unsigned char>(peek()) < 0x20) {
                return refuse("no control characters in a string");
            }
            const std::size_t length = utf8_length(text_.substr(next_));
            if (length == 0) {
                return refuse_at(position(), "bytes that are not UTF-8", "UTF-8");
            }
            out.append(text_.substr(next_, length));
            next_ += length;
        }
        ++next_;
        return true;
    }

    bool parse_escape(std::string& out) {
        const SourcePosition start = position();
        ++next_;
        constexpr std::string_view kLetters = "\"\\/bfnrt";
        constexpr std::string_view kMeanings = "\"\\/\b\f\n\r\t";
        if (const std::size_t i = kLetters.find(peek()); !at_end() && i != std::string_view::npos) {
            out.push_back(kMeanings[i]);
            ++next_;
            return true;
        }
        if (peek() != 'u') {
            return refuse("one of \" \\ / b f n r t u after a backslash");
        }
        std::uint32_t code = 0;
        if (!parse_hex4(code)) {
            return false;
        }
        if (code >= 0xd800 && code < 0xdc00 && text_.substr(next_, 2) == "\\u") {
            ++next_;
            std::uint32_t low = 0;
            if (!parse_hex4(low)) {
                return false;
            }
            if (low < 0xdc00 || low > 0xdfff) {
                return refuse_at(start, "half of a surrogate pair", "both halves");
            }
            code = 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
        } else if (code >= 0xd800 && code <= 0xdfff) {
            return refuse_at(start, "half of a surrogate pair", "both halves");
        }
        append_utf8(out, code);
        return true;
    }

    /// The four digits after the u at next_.
    bool parse_hex4(std::uint32_t& code) {
        ++next_;
        const std::string_view digits = text_.substr(next_, 4);
        const char* const end = digits.data() + digits.size();
        const std::from_chars_result parsed = std::from_chars(digits.data(), end, code, 16);
        if (digits.size() != 4 || parsed.ec != std::errc() || parsed.ptr != end) {
            return refuse("four hexadecimal digits after \\u");
        }
        next_ += 4;
        return true;
    }

    /// Calls parse_item for the items between two brackets, which commas separate.
    template <typename ParseItem>
    bool parse_list(char close, std::string_view expected, ParseItem&& parse_item) {
        ++next_;
        if (!skip_blank()) {
            return false;
        }
        if (peek() == close) {
            ++next_;
            return true;
        }
        while (parse_item()) {
            const std::uint32_t item_end = line_;
            if (!skip_blank()) {
                return false;
            }
            const char c = peek();
            if (c != close && c != ',') {
                return refuse(
                    line_ == item_end
                        ? std::string(expected)
                        : fmt::format("{} (line {} ends without one)", expected, item_end));
            }
            const SourcePosition at = position();
            ++next_;
            if (c == close) {
                return true;
            }
            if (!skip_blank()) {
                return false;
            }
            if (peek() == close) {
                return refuse_at(at, fmt::format("a comma before {}", close), "none there");
            }
        }
        return false;
    }

    bool parse_array(JsonValue& value, int depth) {
        value.kind = JsonKind::Array;
        return parse_list(']', "',' or ']' in the array", [&] {
            return parse_value(value.items.emplace_back(), depth + 1);
        });
    }

    bool parse_object(JsonValue& value, int depth) {
        value.kind = JsonKind::Object;
        const auto parse_member = [&] {
            JsonMember& member = value.members.emplace_back();
            member.at = position();
            if (peek() != '"') {
                return refuse("a key in quotes");
            }
            if (!parse_string(member.key) || !skip_blank()) {
                return false;
            }
            if (peek() != ':') {
                return refuse("':' after the key " + in_quotes(member.key));
            }
            ++next_;
            return skip_blank() && parse_value(member.value, depth + 1);
        };
        return parse_list('}', "',' or '}' in the object", parse_member)
               && check_keys_differ(value);
    }

    bool check_keys_differ(const JsonValue& object) {
        std::unordered_set<std::string_view> keys;
        for (const JsonMember& member : object.members) {
            if (!keys.insert(member.key).second) {
                return refuse_at(
                    member.at, "a duplicate key " + in_quotes(member.key), "each key once");
            }
        }
        return true;
    }

    std::string_view text_;
    std::string_view file_;
    JsonLimits limits_;
    std::size_t next_ = 0;  // position of the next character
    std::uint32_t line_ = 1;
    std::uint32_t column_ = 1;  // of the character at counted_
    std::size_t counted_ = 0;
    std::size_t values_ = 0;
    Error error_;
};

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
        case '"':
            out += "\\\"";
            break;
        case '\\':
            out += "\\\\";
            break;
        case '\n':
            out += "\\n";
            break;
        case '\r':
            out += "\\r";
            break;
        case '\t':
            out += "\\t";
            break;
        default:
            if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
                out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
            } else {
                out.push_back(c);
            }
        }
    }
    return out;
}

std::string write_compact(const JsonValue& value) {
    switch (value.kind) {
    case JsonKind::Null:
        return "null";
    case JsonKind::Bool:
        return value.truth ? "true" : "false";
    case JsonKind::Number:
        return value.text;
    case JsonKind::String:
        return '"' + escaped(value.text) + '"';
    case JsonKind::Array: {
        std::string out = "[";
        for (const JsonValue& item : value.items) {
            out += (out.size() > 1 ? ", " : "") + write_compact(item);
        }
        return out + "]";
    }
    case JsonKind::Object: {
        std::string out = "{";
        for (const JsonMember& member : value.members) {
            out += out.size() > 1 ? ", \"" : "\"";
            out += escaped(member.key) + "\": " + write_compact(member.value);
        }
        return out + "}";
    }
    }
    return "null";
}

/// Containers that do not fit on a line are broken into one item per line.
void write_broken(const JsonValue& value, std::size_t indent, std::size_t used, std::string& out) {
    std::string compact = write_compact(value);
    const bool is_container = value.kind == JsonKind::Array || value.kind == JsonKind::Object;
    const bool is_empty = value.items.empty() && value.members.empty();
    if (!is_container || is_empty || indent + used + compact.size() < kLineWidth) {
        out += compact;
        return;
    }
    const bool is_array = value.kind == JsonKind::Array;
    const std::size_t count = is_array ? value.items.size() : value.members.size();
    const std::string inner(indent + 2, ' ');
    out += is_array ? "[\n" : "{\n";
    for (std::size_t i = 0; i < count; ++i) {
        out += inner;
        if (is_array) {
            write_broken(value.items[i], indent + 2, 0, out);
        } else {
            const std::string key = '"' + escaped(value.members[i].key) + "\": ";
            out += key;
            write_broken(value.members[i].value, indent + 2, key.size(), out);
        }
        out += i + 1 < count ? ",\n" : "\n";
    }
    out += std::string(indent, ' ') + (is_array ? "]" : "}");
}

template <typename Number>
JsonValue number_of(Number number) {
    LIMN_CHECK(std::isfinite(static_cast<double>(number)));
    char spelling[64];
    const std::to_chars_result end = std::to_chars(spelling, spelling + sizeof(spelling), number);
    JsonValue value;
    value.kind = JsonKind::Number;
    value.number = static_cast<double>(number);
    value.text.assign(spelling, end.ptr);
    return value;
}

}  // namespace

const JsonValue* JsonValue::find(std::string_view key) const {
    for (const JsonMember& member : members) {
        if (member.key == key) {
            return &member.value;
        }
    }
    return nullptr;
}

const JsonValue& JsonValue::operator[](std::string_view key) const {
    static const JsonValue null;
    const JsonValue* const member = find(key);
    return member != nullptr ? *member : null;
}

std::string location_text(std::string_view file, SourcePosition at) {
    const std::string_view name = at.file != nullptr ? *at.file : file;
    return at.line > 0 ? fmt::format("{}:{}:{}", name, at.line, at.column) : std::string(name);
}

Result<JsonValue>
parse_json(std::string_view text, std::string_view file, const JsonLimits& limits) {
    return JsonParser(text, file, limits).parse();
}

Result<JsonValue> load_json(const std::string& path, const JsonLimits& limits) {
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path, limits.max_bytes));
    return parse_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path, limits);
}

std::string write_json(const JsonValue& value) {
    std::string out;
    write_broken(value, 0, 0, out);
    return out;
}

JsonValue json_of(bool truth) {
    JsonValue value;
    value.kind = JsonKind::Bool;
    value.truth = truth;
    return value;
}

JsonValue json_of(float number) {
    return number_of(number);
}
JsonValue json_of(double number) {
    return number_of(number);
}
JsonValue json_of(std::int64_t number) {
    return number_of(number);
}
JsonValue json_of(std::uint64_t number) {
    return number_of(number);
}

JsonValue json_of(std::string_view text) {
    JsonValue value;
    value.kind = JsonKind::String;
    value.text = text;
    return value;
}

JsonValue json_array(std::vector<JsonValue> items) {
    JsonValue value;
    value.kind = JsonKind::Array;
    value.items = std::move(items);
    return value;
}

JsonValue json_object(std::vector<JsonMember> members) {
    JsonValue value;
    value.kind = JsonKind::Object;
    value.members = std::move(members);
    return value;
}

std::string describe(const JsonValue& value) {
    switch (value.kind) {
    case JsonKind::Null:
        return "null";
    case JsonKind::Bool:
        return value.truth ? "true" : "false";
    case JsonKind::Number:
        return "the number " + value.text.substr(0, kQuotedBytes);
    case JsonKind::String:
        return "the string " + in_quotes(value.text);
    case JsonKind::Array:
        return fmt::format("an array of {}", value.items.size());
    case JsonKind::Object:
        return "an object";
    }
    return "nothing";
}

std::string in_quotes(std::string_view text) {
    std::string shown;
    std::size_t i = 0;
    while (i < text.size() && shown.size() < kQuotedBytes) {
        const std::size_t length = utf8_length(text.substr(i));
        shown += length == 0 ? std::string("\\x")
                                   + fmt::format("{:02x}", static_cast<unsigned char>(text[i]))
                             : escaped(text.substr(i, length));
        i += std::max<std::size_t>(length, 1);
    }
    return '"' + shown + (i < text.size() ? "...\"" : "\"");
}

std::string did_you_mean(std::string_view name, std::span<const std::string_view> candidates) {
    // Long names are rarely typos, and the search is quadratic in their length.
    constexpr std::size_t kLongestName = 64;
    std::vector<std::string_view> short_ones;
    std::copy_if(
        candidates.begin(), candidates.end(), std::back_inserter(short_ones),
        [](std::string_view c) { return c.size() <= kLongestName; });
    // Among equally near ones the one with the longest common prefix comes first.
    std::stable_sort(
        short_ones.begin(), short_ones.end(), [name](std::string_view a, std::string_view b) {
            const auto alike = [name](std::string_view other) {
                return std::mismatch(name.begin(), name.end(), other.begin(), other.end()).first
                       - name.begin();
            };
            return alike(a) > alike(b);
        });
    const std::string nearest =
        name.size() <= kLongestName ? nearest_name(name, short_ones) : std::string();
    return nearest.empty() ? "" : fmt::format(" (did you mean {}?)", nearest);
}

}  // namespace limn
