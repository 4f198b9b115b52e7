// Reports what shows in a block, for each block in a pixel: which patches showed once, of which groups enough does, how
// many holes there are and of which slots something shows.
uniform usampler2D claims;
uniform usampler2D winners;
uniform ivec2 viewport;
layout(location = 0) out uvec4 out_claims;
// A bit for each of the first 64 patches that leads a group of which enough shows; holes; slots.
layout(location = 1) out uvec4 out_figures;
const int enough_pixels = 6;
void main() {
    ivec2 corner = 16 * ivec2(gl_FragCoord.xy);
    int counts[64];
    for (int i = 0; i < 64; ++i) {
        counts[i] = 0;
    }
    out_claims = uvec4(0u);
    out_figures = uvec4(0u);
    ivec2 extent = min(viewport - corner, ivec2(16));
    for (int y = 0; y < extent.y; ++y) {
        for (int x = 0; x < extent.x; ++x) {
            ivec2 pixel = corner + ivec2(x, y);
            out_claims |= texelFetch(claims, pixel, 0);
            uint winner = texelFetch(winners, pixel, 0).x;
            if ((winner & 0x20000u) != 0u) {
                ++counts[min(winner & 255u, 63u)];
                out_figures.w |= 1u << (winner >> 8 & 31u);
            }
            out_figures.z += (winner & 0x10000u) == 0u ? 1u : 0u;
        }
    }
    for (int i = 0; i < 32; ++i) {
        out_figures.x |= counts[i] >= enough_pixels ? 1u << i : 0u;
        out_figures.y |= counts[i + 32] >= enough_pixels ? 1u << i : 0u;
    }
}
