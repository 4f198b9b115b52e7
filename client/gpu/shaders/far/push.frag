// Fills cells that are nothing from those of twice the side; also those just beyond the picture, for which there is a
// border of one cell.
uniform sampler2D fine; // without a border
uniform sampler2D coarse;
uniform int coarse_border; // cells of border that it has; the last cell is repeated beyond that
out vec4 cell;
vec4 at(int x, int y) {
    return texelFetch(coarse, clamp(ivec2(x, y) + coarse_border, ivec2(0), textureSize(coarse, 0) - 1), 0);
}
void main() {
    ivec2 position = ivec2(gl_FragCoord.xy) - 1;
    bool is_there = all(greaterThanEqual(position, ivec2(0))) && all(lessThan(position, textureSize(fine, 0)));
    cell = is_there ? texelFetch(fine, position, 0) : vec4(0.0, 0.0, 0.0, nothing);
    if (is_nothing(cell)) {
        ivec2 own = parent_of(position);
        ivec2 other = other_of(position);
        cell = farthest_of(vec4(9.0, 3.0, 3.0, 1.0), at(own.x, own.y), at(other.x, own.y), at(own.x, other.y),
                           at(other.x, other.y));
    }
}
