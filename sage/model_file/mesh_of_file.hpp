// A mesh of another program in place of a drawing's own.  Not part of the public interface.
#pragma once

#include "sage/exchange/foreign_mesh.hpp"
#include "sage/section/section_mesh.hpp"

namespace sage::model_file {

// The corners of the mesh's elements.  Areas and lines of the section are its named surfaces and curves, which give them their
// outlines and points; points of the section are nodes of the mesh where one lies there.  Throws SectionError.
GivenMesh take_mesh(const ForeignMesh& mesh, Section& section);

}  // namespace sage::model_file
