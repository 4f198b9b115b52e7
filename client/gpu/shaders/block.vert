// Draws the square of each block that is painted: one instance each, of four corners.
uniform usampler2D blocks;
uniform vec2 size; // of the picture, pixels
flat out uvec4 block; // as `PatchTable::blocks`
flat out int first_splat;
void main() {
    block = texel_of(blocks, 2 * gl_InstanceID);
    first_splat = int(texel_of(blocks, 2 * gl_InstanceID + 1).x);
    vec2 corner = vec2(block.x & 0xffffu, block.x >> 16) + vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(corner * 16.0 / size * 2.0 - 1.0, 0.0, 1.0);
}
