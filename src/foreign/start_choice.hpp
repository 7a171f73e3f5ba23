// Choice of the start: a topology with as many atoms as the System has particles, or a State.
#pragma once

#include <string>

#include "foreign/contents.hpp"
#include "foreign/files.hpp"

namespace catena::foreign {

/// Sets topology or State to what the user names. Throws InputError for a file that is absent, is
/// something else, or does not fit the System.
void take_named_start(std::string const& named, Contents const& contents, Files& files);

/// Sets topology or State to the only one of the folder that fits, with a note on what is not read.
/// Throws InputError if there is none or more than one.
void take_only_start(Contents const& contents, Files& files);

/// Throws InputError if the chosen topology cannot be read or does not have one atom for each
/// particle. `remedy` says what to do.
void refuse_unfit_topology(Files const& files, std::string const& remedy);

}  // namespace catena::foreign
