// Tables in textures of 1024 texels a row.
uvec4 texel_of(usampler2D table, int index) {
    return texelFetch(table, ivec2(index & 1023, index >> 10), 0);
}
