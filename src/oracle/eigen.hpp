// Dense Eigen matrices of any oracle scalar, without their decompositions. Internal to the oracles.
#pragma once

#include <Eigen/Core>

#include "oracle/algebra.hpp"

namespace Eigen {
/// Properties of Quad for Eigen.
template <>
struct NumTraits<catena::oracle::Quad> : GenericNumTraits<double> {
    using Real = catena::oracle::Quad;
    using NonInteger = catena::oracle::Quad;
    using Nested = catena::oracle::Quad;
    using Literal = catena::oracle::Quad;
    enum {
        IsComplex = 0,
        IsInteger = 0,
        IsSigned = 1,
        RequireInitialization = 0,
        ReadCost = 2,
        AddCost = 40,
        MulCost = 40
    };
    static Real epsilon() { return Real::epsilon(); }
    static Real dummy_precision() { return Real(0x1p-104); }
    static int digits10() { return 33; }
};
}  // namespace Eigen

namespace catena::oracle {

using Index = Eigen::Index;
/// Matrix of dynamic size.
template <class S>
using Dense = Eigen::Matrix<S, Eigen::Dynamic, Eigen::Dynamic>;
/// Vector of dynamic size.
template <class S>
using Column = Eigen::Matrix<S, Eigen::Dynamic, 1>;

}  // namespace catena::oracle
