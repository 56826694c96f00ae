// Small text over an image: letters of 5 x 8 dots, the lowest row for descenders.

const int kGlyphs = 27;
// Letters a .. z and a dash; four rows of five bits each from the top, lowest bit left.
const uvec2 kGlyphRows[kGlyphs] = uvec2[](
    uvec2(0x83800u, 0x07a3eu), uvec2(0x9b421u, 0x03e31u), uvec2(0x0b800u, 0x03a21u), uvec2(0xcda10u, 0x07a31u),
    uvec2(0x8b800u, 0x0383fu), uvec2(0x38a4cu, 0x00842u), uvec2(0x8f800u, 0x743d1u), uvec2(0x9b421u, 0x04631u),
    uvec2(0x21804u, 0x03884u), uvec2(0x43008u, 0x32508u), uvec2(0x2a421u, 0x024a3u), uvec2(0x21086u, 0x03884u),
    uvec2(0xaac00u, 0x04635u), uvec2(0x9b400u, 0x04631u), uvec2(0x8b800u, 0x03a31u), uvec2(0x8bc00u, 0x085f1u),
    uvec2(0x8f800u, 0x843d1u), uvec2(0x9b400u, 0x00421u), uvec2(0x0b800u, 0x03e0eu), uvec2(0x11c42u, 0x03242u),
    uvec2(0x8c400u, 0x05b31u), uvec2(0x8c400u, 0x01151u), uvec2(0x8c400u, 0x02ab5u), uvec2(0x54400u, 0x04544u),
    uvec2(0x8c400u, 0x743d1u), uvec2(0x47c00u, 0x07c44u), uvec2(0x00000u, 0x0001fu));
const vec2 kGlyphCell = vec2(6.0, 9.0);  // with the gaps [dots]

// Whether a glyph has a dot at `at`, x to the right and y down; glyphs that kGlyphRows lacks are blank.
bool has_dot(int glyph, ivec2 at) {
    if (glyph < 0 || glyph >= kGlyphs || any(lessThan(at, ivec2(0))) || at.x >= 5 || at.y >= 8) {
        return false;
    }
    uint rows = at.y < 4 ? kGlyphRows[glyph].x : kGlyphRows[glyph].y;
    return (rows >> uint(5 * (at.y % 4) + at.x) & 1u) != 0u;
}
