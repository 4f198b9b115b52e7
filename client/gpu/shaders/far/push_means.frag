// Fills means that are nothing from the coarser ones.
uniform sampler2D fine;
uniform sampler2D coarse;
out vec4 mean;
vec4 at(int x, int y) {
    return texelFetch(coarse, clamp(ivec2(x, y), ivec2(0), textureSize(coarse, 0) - 1), 0);
}
void main() {
    ivec2 position = ivec2(gl_FragCoord.xy);
    mean = texelFetch(fine, position, 0);
    if (is_nothing(mean)) {
        ivec2 own = parent_of(position);
        ivec2 other = other_of(position);
        mean = known_of(vec4(9.0, 3.0, 3.0, 1.0), at(own.x, own.y), at(other.x, own.y), at(own.x, other.y),
                        at(other.x, other.y));
    }
}
