// Numbers of floating-point operations of the solver's own functions, which run with a scalar that
// counts.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace catena {

/// Numbers of operations by kind.
struct Operations {
    /// Changes of sign are not counted.
    std::int64_t additions = 0, multiplications = 0, fused = 0, divisions = 0, square_roots = 0;
    /// A fused multiplication and addition counts as two.
    std::int64_t sum() const {
        return additions + multiplications + 2 * fused + divisions + square_roots;
    }
};

/// A double that counts the operations done with it, in a counter of this thread.
class Counted {
  public:
    Counted() = default;
    explicit Counted(double value) : value_(value) {}
    double value() const { return value_; }
    /// Returns the counter of this thread, which the caller may reset.
    static Operations& done() {
        static thread_local Operations operations;
        return operations;
    }

    friend Counted operator+(Counted a, Counted b) {
        return ++done().additions, Counted(a.value_ + b.value_);
    }
    friend Counted operator-(Counted a, Counted b) {
        return ++done().additions, Counted(a.value_ - b.value_);
    }
    friend Counted operator*(Counted a, Counted b) {
        return ++done().multiplications, Counted(a.value_ * b.value_);
    }
    friend Counted operator/(Counted a, Counted b) {
        return ++done().divisions, Counted(a.value_ / b.value_);
    }
    friend Counted operator-(Counted a) { return Counted(-a.value_); }
    friend Counted fused(Counted a, Counted b, Counted c) {
        return ++done().fused, Counted(std::fma(a.value_, b.value_, c.value_));
    }
    friend Counted sqrt(Counted a) { return ++done().square_roots, Counted(std::sqrt(a.value_)); }
    friend bool operator<(Counted a, Counted b) { return a.value_ < b.value_; }
    friend bool any_above(Counted a, double bound) { return std::abs(a.value_) > bound; }
    friend Counted where_less(Counted a, Counted b, Counted yes, Counted no) {
        return a < b ? yes : no;
    }

  private:
    double value_ = 0;
};

/// Operations for one body or one joint with one kind of handles, in the functions as written.
struct HandleOperations {
    // directions per handle
    int directions = 0;
    /// Operations of a leaf; the first two include both handles of a body.
    Operations leaf_matrices, leaf_biases, leaf_accelerations;
    // operations per merge of two segments
    Operations assembly_matrices, assembly_biases, disassembly;
    std::int64_t assembly() const { return assembly_matrices.sum() + assembly_biases.sum(); }
    std::int64_t leaf() const {
        return leaf_matrices.sum() + leaf_biases.sum() + leaf_accelerations.sum();
    }
};
/// Operations for one joint type.
struct JointOperations {
    std::string joint;
    HandleOperations projected, full;
};
/// Counts the operations for every joint type: link (point beads), planar, spherical, universal,
/// revolute, sliding (prismatic, helical), weld.
std::vector<JointOperations> count_operations();

}  // namespace catena
