// Access to the implementation behind an OpenMM Context. Only files that see OpenMM's headers
// include this one.
#pragma once

#include <OpenMM.h>
#include <openmm/internal/ContextImpl.h>

namespace catena {

/// Returns the ContextImpl of `context`, which OpenMM does not make public.
inline OpenMM::ContextImpl& impl_of(OpenMM::Context& context) {
    /// OpenMM gives every Force access to its Context's implementation; this Force does nothing
    /// else.
    struct Key : OpenMM::Force {
        OpenMM::ContextImpl& open(OpenMM::Context& c) const { return getContextImpl(c); }
        OpenMM::ForceImpl* createImpl() const override { return nullptr; }
    };
    return Key().open(context);
}

}  // namespace catena
