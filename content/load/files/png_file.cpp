#include "content/load/files/png_file.h"

#include "content/load/files/atomic_file.h"
#include "content/load/files/image_load.h"
#include "content/load/files/png_check.h"
#include "ecs/base/check.h"
#include "ecs/base/text.h"
#include "ecs/components/surface.h"

#include <algorithm>
#include <cstring>
#include <png.h>
#include <utility>

namespace limn {

namespace {

/// State of libpng's callbacks. libpng reports errors by a jump to the caller's setjmp, so that
/// functions that call it hold no objects with destructors; those are here.
struct PngState {
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::string error = {};
    std::span<const std::byte> rest = {};    // to read
    std::vector<std::uint8_t> written = {};  // the file
    std::vector<png_bytep> rows = {};        // into the pixels
    std::vector<std::uint8_t> pixels = {};   // RGBA, read
    int width = 0;
    int height = 0;
};

PngState& state_of(png_structp png) {
    return *static_cast<PngState*>(png_get_error_ptr(png));
}

[[noreturn]] void report_error(png_structp png, png_const_charp message) {
    state_of(png).error = message;
    png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

void read_bytes(png_structp png, png_bytep to, std::size_t count) {
    std::span<const std::byte>& rest = static_cast<PngState*>(png_get_io_ptr(png))->rest;
    if (count > rest.size()) {
        png_error(png, "truncated");
    }
    std::memcpy(to, rest.data(), count);
    rest = rest.subspan(count);
}

void write_bytes(png_structp png, png_bytep from, std::size_t count) {
    std::vector<std::uint8_t>& file = static_cast<PngState*>(png_get_io_ptr(png))->written;
    file.insert(file.end(), from, from + count);
}

void flush_nothing(png_structp) {}

/// Reads the header; false, with `error`, if libpng finds it corrupt.
bool read_header(PngState& state) {
    if (setjmp(png_jmpbuf(state.png)) != 0) {
        return false;
    }
    png_set_read_fn(state.png, &state, read_bytes);
    png_set_user_limits(state.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // our own are checked next
    png_read_info(state.png, state.info);
    state.width = static_cast<int>(png_get_image_width(state.png, state.info));
    state.height = static_cast<int>(png_get_image_height(state.png, state.info));
    return true;
}

/// Reads the pixels as RGBA with 8 or 16 bits into `rows`.
bool read_rows(PngState& state, int bits) {
    if (setjmp(png_jmpbuf(state.png)) != 0) {
        return false;
    }
    png_set_expand(state.png);  // palettes, less than 8 bits, transparent colors
    if (bits == 16) {
        png_set_expand_16(state.png);
        png_set_swap(state.png);  // the file is big endian
    } else {
        png_set_scale_16(state.png);
    }
    png_set_gray_to_rgb(state.png);
    png_set_add_alpha(state.png, bits == 16 ? 0xffff : 0xff, PNG_FILLER_AFTER);
    png_set_interlace_handling(state.png);
    png_read_update_info(state.png, state.info);
    if (png_get_rowbytes(state.png, state.info)
        != static_cast<std::size_t>(state.width) * 4 * static_cast<std::size_t>(bits / 8)) {
        png_error(state.png, "unexpected row size");
    }
    png_read_image(state.png, state.rows.data());
    png_read_end(state.png, nullptr);
    return true;
}

bool write_rows(PngState& state, int channels, int bits) {
    if (setjmp(png_jmpbuf(state.png)) != 0) {
        return false;
    }
    constexpr int kColorTypes[] = {
        PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGBA};
    png_set_write_fn(state.png, &state, write_bytes, flush_nothing);
    png_set_IHDR(
        state.png, state.info, static_cast<png_uint_32>(state.width),
        static_cast<png_uint_32>(state.height), bits, kColorTypes[channels - 1], PNG_INTERLACE_NONE,
        PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(state.png, state.info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(state.png, state.info);
    if (bits == 16) {
        png_set_swap(state.png);  // the file is big endian
    }
    png_write_image(state.png, state.rows.data());
    png_write_end(state.png, nullptr);
    return true;
}

void fill_png_rows(PngState& state, std::uint8_t* pixels, std::size_t row_size) {
    state.rows.resize(static_cast<std::size_t>(state.height));
    for (std::size_t y = 0; y < state.rows.size(); ++y) {
        state.rows[y] = pixels + y * row_size;
    }
}

template <typename T>
Result<std::vector<std::uint8_t>>
encode(int width, int height, int channels, std::span<const T> values) {
    LIMN_CHECK(width > 0 && height > 0 && channels >= 1 && channels <= 4);
    const std::size_t row = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
    LIMN_CHECK(values.size() == row * static_cast<std::size_t>(height));
    PngState state{.width = width, .height = height};
    state.png =
        png_create_write_struct(PNG_LIBPNG_VER_STRING, &state, report_error, ignore_warning);
    state.info = state.png != nullptr ? png_create_info_struct(state.png) : nullptr;
    // libpng takes rows that are not const and does not write to them.
    auto* const bytes = reinterpret_cast<std::uint8_t*>(const_cast<T*>(values.data()));
    fill_png_rows(state, bytes, row * sizeof(T));
    const bool written = state.info != nullptr && write_rows(state, channels, 8 * sizeof(T));
    png_destroy_write_struct(&state.png, &state.info);
    if (!written) {
        return fail("cannot encode PNG: {}", state.error);
    }
    return std::move(state.written);
}

template <typename T>
Status write_values(
    const std::string& path, int width, int height, int channels, std::span<const T> values) {
    const Result<std::vector<std::uint8_t>> bytes = encode(width, height, channels, values);
    if (!bytes) {
        return fail("{}: {}", path, bytes.error().message);
    }
    return write_file(path, std::as_bytes(std::span(*bytes)));
}

Status read_png(PngState& state, int bits, const std::string& location, const ImageLimits& limits) {
    if (state.info == nullptr || !read_header(state)) {
        return fail("{}: corrupt PNG image: {}", location, state.error);
    }
    const std::string too_large = image_size_error(state.width, state.height, limits);
    if (!too_large.empty()) {
        return fail("{}: {}", location, too_large);
    }
    const std::size_t row =
        static_cast<std::size_t>(state.width) * 4 * static_cast<std::size_t>(bits / 8);
    state.pixels.resize(row * static_cast<std::size_t>(state.height));
    fill_png_rows(state, state.pixels.data(), row);
    if (!read_rows(state, bits)) {
        return fail("{}: corrupt PNG image: {}", location, state.error);
    }
    return Done{};
}

/// The state after reading, with the pixels.
Result<PngState> decode_rows(
    std::span<const std::byte> bytes, int bits, const std::string& location,
    const ImageLimits& limits) {
    LIMN_TRY(check_png(bytes, location));
    PngState state{.rest = bytes};
    state.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &state, report_error, ignore_warning);
    state.info = state.png != nullptr ? png_create_info_struct(state.png) : nullptr;
    const Status read = read_png(state, bits, location, limits);
    png_destroy_read_struct(&state.png, &state.info, nullptr);
    if (!read) {
        return read.error();
    }
    return state;
}

}  // namespace

Status write_png(
    const std::string& path, int width, int height, int channels,
    std::span<const std::uint8_t> pixels) {
    return write_values(path, width, height, channels, pixels);
}

Status write_png16(
    const std::string& path, int width, int height, int channels,
    std::span<const std::uint16_t> pixels) {
    return write_values(path, width, height, channels, pixels);
}

Result<std::vector<std::uint8_t>>
png_bytes(int width, int height, int channels, std::span<const std::uint8_t> pixels) {
    return encode(width, height, channels, pixels);
}

Result<ImageData> decode_png(
    std::span<const std::byte> bytes, const std::string& location, const ImageLimits& limits) {
    PngState state = LIMN_TRY(decode_rows(bytes, 8, location, limits));
    ImageData image;
    image.name = location;
    image.width = state.width;
    image.height = state.height;
    image.pixels = std::move(state.pixels);
    return image;
}

Result<Png16> decode_png16(
    std::span<const std::byte> bytes, const std::string& location, const ImageLimits& limits) {
    const PngState state = LIMN_TRY(decode_rows(bytes, 16, location, limits));
    Png16 image = {.width = state.width, .height = state.height};
    image.pixels.resize(state.pixels.size() / sizeof(std::uint16_t));
    std::memcpy(image.pixels.data(), state.pixels.data(), state.pixels.size());
    return image;
}

}  // namespace limn
