// What is behind a Context. For files that see OpenMM's headers.
#pragma once

#include <OpenMM.h>
#include <openmm/internal/ContextImpl.h>

namespace catena {

inline OpenMM::ContextImpl& impl_of(OpenMM::Context& context) {
    /// Every force may look into its Context; this one does nothing else.
    struct Key : OpenMM::Force {
        OpenMM::ContextImpl& open(OpenMM::Context& c) const { return getContextImpl(c); }
        OpenMM::ForceImpl* createImpl() const override { return nullptr; }
    };
    return Key().open(context);
}

}  // namespace catena
