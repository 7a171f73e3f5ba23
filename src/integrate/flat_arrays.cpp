// Conversions between arrays of vectors, of numbers, of pieces and of bodies.
#include "integrate/flat_arrays.hpp"

namespace catena {

std::vector<double> flat(std::vector<Vec3> const& values) {
    std::vector<double> out;
    out.reserve(3 * values.size());
    for (Vec3 const& v : values) out.insert(out.end(), v.data, v.data + 3);
    return out;
}
std::vector<Vec3> triples(std::vector<double> const& values) {
    std::vector<Vec3> out(values.size() / 3);
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = {{values[3 * i], values[3 * i + 1], values[3 * i + 2]}};
    return out;
}

std::vector<double> at_starts(ChainGroup const& group, Field<3> const& of_piece) {
    std::vector<Vec3> of_body(static_cast<std::size_t>(group.size), Vec3::zero());
    for (std::size_t p = 0; p < group.pieces.size(); ++p)
        if (group.pieces[p].starts)
            of_body[static_cast<std::size_t>(group.pieces[p].local)] =
                of_piece[static_cast<std::int64_t>(p)];
    return flat(of_body);
}
Field<3> of_starts(ChainGroup const& group, std::vector<Vec3> const& of_body) {
    Field<3> of_piece(std::ssize(group.pieces));
    for (std::size_t p = 0; p < group.pieces.size(); ++p)
        of_piece.set(static_cast<std::int64_t>(p),
                     of_body[static_cast<std::size_t>(group.pieces[p].local)]);
    return of_piece;
}

}  // namespace catena
