// Owners of MPI objects, and the conversion of MPI error codes to exceptions.
#pragma once

#include <mpi.h>

#include <exception>
#include <string>
#include <utility>

#include "error.hpp"
#include "mpi/communicator.hpp"

namespace catena {

/// Throws ComputationError with MPI's text if `code` is an error. `call` names the MPI function.
inline void check_mpi(int code, char const* call) {
    if (code == MPI_SUCCESS) return;
    char text[MPI_MAX_ERROR_STRING] = "unknown error";
    int length = 0;
    MPI_Error_string(code, text, &length);
    throw ComputationError(std::string("MPI failed: ") + text + " (" + call +
                           "): check that every rank and its host are still running");
}

/// Returns the MPI communicator of these ranks; MPI_COMM_NULL if they do not communicate by MPI.
MPI_Comm handle_of(Communicator const&);

/// True while an exception propagates that began after construction. Other ranks may not know of
/// it, so that collective calls could wait forever.
class Unwinding {
  public:
    explicit operator bool() const { return std::uncaught_exceptions() > at_start_; }

  private:
    int at_start_ = std::uncaught_exceptions();
};

/// Owner of an MPI communicator, which its destructor frees. MPI_COMM_NULL means none.
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
