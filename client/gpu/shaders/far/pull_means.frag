// Means of four blocks, or of four such means, as `FarMeans`; beyond the last one it is repeated.
uniform sampler2D fine;
out vec4 mean;
vec4 at(ivec2 position) {
    return texelFetch(fine, min(position, textureSize(fine, 0) - 1), 0);
}
void main() {
    ivec2 first = 2 * ivec2(gl_FragCoord.xy);
    mean = known_of(vec4(1.0), at(first), at(first + ivec2(1, 0)), at(first + ivec2(0, 1)), at(first + ivec2(1, 1)));
}
