// Owners of what MPI hands out, and the one way an MPI failure becomes an error.
#pragma once

#include <mpi.h>

#include <exception>
#include <string>
#include <utility>

#include "error.hpp"
#include "mpi/communicator.hpp"

namespace catena {

inline void check_mpi(int code, char const* call) {
    if (code == MPI_SUCCESS) return;
    char text[MPI_MAX_ERROR_STRING] = "unknown error";
    int length = 0;
    MPI_Error_string(code, text, &length);
    throw ComputationError(std::string("MPI failed: ") + text + " (" + call +
                           "): see whether every rank and its host are still up");
}

/// MPI's communicator of these ranks; MPI_COMM_NULL where they speak in another way.
MPI_Comm handle_of(Communicator const&);

/// Whether an error is on its way out that other ranks may not know of: to wait for them then would
/// be for ever.
class Unwinding {
  public:
    explicit operator bool() const { return std::uncaught_exceptions() > at_start_; }

  private:
    int at_start_ = std::uncaught_exceptions();
};

/// A communicator of MPI's, freed at its end; MPI_COMM_NULL is none.
class MpiHandle {
  public:
    explicit MpiHandle(MPI_Comm handle) : handle_(handle) {
        if (handle_ != MPI_COMM_NULL)
            check_mpi(MPI_Comm_set_errhandler(handle_, MPI_ERRORS_RETURN),
                      "MPI_Comm_set_errhandler");
    }
    MpiHandle(MpiHandle&& other) noexcept : handle_(std::exchange(other.handle_, MPI_COMM_NULL)) {}
    MpiHandle& operator=(MpiHandle&&) = delete;
    ~MpiHandle() {
        if (handle_ != MPI_COMM_NULL && !unwinding_) MPI_Comm_free(&handle_);
    }
    operator MPI_Comm() const { return handle_; }
    int rank() const {
        int rank = 0;
        check_mpi(MPI_Comm_rank(handle_, &rank), "MPI_Comm_rank");
        return rank;
    }
    int size() const {
        int size = 1;
        check_mpi(MPI_Comm_size(handle_, &size), "MPI_Comm_size");
        return size;
    }

  private:
    MPI_Comm handle_;
    Unwinding unwinding_;
};

}  // namespace catena
