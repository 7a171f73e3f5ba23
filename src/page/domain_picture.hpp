// Picture of the rigid domains that were found in a predicted structure, as an SVG file of its own.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace catena {

/// Confidences of one chain and the domains that follow from them. Residues count from 0.
struct DomainPicture {
    std::string title;
    /// pLDDT of each residue, 0 to 100.
    std::vector<double> plddt;
    /// Predicted aligned error of two residues, angstrom.
    std::function<double(std::size_t, std::size_t)> error;
    /// Thresholds that decided: least pLDDT, largest error.
    double least_plddt = 0, largest_error = 0;
    /// First and last residue of each domain.
    std::vector<std::array<std::size_t, 2>> domains;
};

/// Returns the text of an SVG file: pLDDT along the chain with the domains shaded, and below it the
/// matrix of errors with a square around each domain. Several pictures stand below each other.
std::string domain_pictures(std::vector<DomainPicture> const& pictures);

}  // namespace catena
