# How everything is compiled: language, floating point, warnings, sanitizers, ccache.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)
set_property(GLOBAL PROPERTY USE_FOLDERS ON)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release or RelWithDebInfo" FORCE)
endif()

option(CATENA_WERROR "Warnings are errors (tests/run.sh sets it)" OFF)
set(CATENA_SANITIZE "" CACHE STRING "Sanitizers, as for -fsanitize=: address,undefined or thread; empty: none")
option(CATENA_SANITIZE_QUICKLY "A third of the time to compile: no sanitizers in src/dca, no vectors, and no checks of undefined behaviour that ends in a signal" OFF)

# One instruction set for the whole build, the same on every machine that builds it: results are promised bit for bit for
# an instruction set, and whether a*b+c is one rounding or two (FMA, from x86-64-v3 on) is the part of it that shows.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
    if(NOT DEFINED CACHE{CATENA_ARCH})
        include(CheckCXXSourceRuns)
        set(CMAKE_REQUIRED_FLAGS "-march=x86-64-v3 -O1")
        check_cxx_source_runs([[
            #include <immintrin.h>
            int main(int argc, char**) {
                __m256d const a = _mm256_set1_pd(argc);
                __m256i const b = _mm256_add_epi64(_mm256_castpd_si256(_mm256_fmadd_pd(a, a, a)), _mm256_castpd_si256(a));
                return _mm256_extract_epi64(b, 0) == 0 ? 1 : 0;
            }]] CATENA_HOST_RUNS_V3)
        unset(CMAKE_REQUIRED_FLAGS)
        if(NOT CATENA_HOST_RUNS_V3)
            message(WARNING "This machine cannot run x86-64-v3 code (AVX2, FMA): compiling for the compiler's default processor. "
                            "Results then differ in their last bits from builds for x86-64-v3. Name another with -DCATENA_ARCH=...")
            set(catena_default_arch "")
        else()
            set(catena_default_arch "x86-64-v3")
        endif()
    endif()
    set(CATENA_ARCH "${catena_default_arch}" CACHE STRING "Instruction set, as for -march=; empty: the compiler's default")
endif()

# Public, because the mathematics is in headers: a program that uses the library instantiates the same templates, the
# linker keeps one copy of each, and that copy must round alike.
set(CATENA_ARITHMETIC_FLAGS -ffp-contract=off)
if(CATENA_ARCH)
    list(APPEND CATENA_ARITHMETIC_FLAGS -march=${CATENA_ARCH})
endif()

add_library(catena_warnings INTERFACE)
target_compile_options(catena_warnings INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wall;-Wextra;-Wpedantic;-Wshadow>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # False alarms on "text" + std::string (GCC bug 105651).
    target_compile_options(catena_warnings INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-restrict>)
endif()
set(CMAKE_COMPILE_WARNING_AS_ERROR ${CATENA_WERROR})

if(CATENA_SANITIZE)
    add_compile_definitions(CATENA_WHOLE=)  # checks of what is inlined whole are six times as long to compile
    add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-fsanitize=${CATENA_SANITIZE}> $<$<COMPILE_LANGUAGE:CXX>:-fno-omit-frame-pointer>)
    add_link_options(-fsanitize=${CATENA_SANITIZE})
    if(CATENA_SANITIZE MATCHES "undefined")
        add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-fno-sanitize-recover=undefined>)
        if(CATENA_SANITIZE_QUICKLY)
            add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-fno-sanitize=null,alignment,object-size,vptr,nonnull-attribute,returns-nonnull-attribute>)
        endif()
    endif()
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-Wno-maybe-uninitialized>)  # false alarms under sanitizers (GCC's manual)
    endif()
endif()

option(CATENA_PRECOMPILE "Precompile the headers of the standard library, fmt and JSON: half of the time to compile. OFF shows missing includes" ON)

find_program(CATENA_CCACHE ccache)
mark_as_advanced(CATENA_CCACHE)
if(CATENA_CCACHE)
    # Without this ccache does not keep what was compiled with a precompiled header.
    set(launcher "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros "${CATENA_CCACHE}")
    foreach(language IN ITEMS C CXX CUDA)
        if(NOT DEFINED CMAKE_${language}_COMPILER_LAUNCHER)
            set(CMAKE_${language}_COMPILER_LAUNCHER "${launcher}")
        endif()
    endforeach()
endif()

# catena_precompile(<target> headers...): headers that most of the target's sources include.
function(catena_precompile target)
    if(CATENA_PRECOMPILE)
        target_precompile_headers(${target} PRIVATE ${ARGN})
        catena_precompiled_options(${target})
    endif()
endfunction()

# catena_reuse_precompiled(<target> <other>): the headers that `other` precompiled, for a target with the same options.
function(catena_reuse_precompiled target other)
    if(CATENA_PRECOMPILE)
        target_precompile_headers(${target} REUSE_FROM ${other})
        catena_precompiled_options(${target})
    endif()
endfunction()

function(catena_precompiled_options target)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        # ccache needs the first. Precompiled headers lose that they are the system's, so gcc warns of them: falsely (GCC bug 105651).
        target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-fpch-preprocess;-Wno-stringop-overflow;-Wno-stringop-overread;-Wno-array-bounds>)
    endif()
endfunction()

option(CATENA_UNITY "Compile up to eight sources of a folder together: less time for a first build, more for each change" OFF)

# catena_openmm_sources(<target> sources...): sources that need OpenMM's library. No source of another kind is compiled together with them, so that
# a program that defines the functions of force/no_openmm.cpp itself links nothing of OpenMM.
function(catena_openmm_sources target)
    target_sources(${target} PRIVATE ${ARGN})
    list(TRANSFORM ARGN PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/" OUTPUT_VARIABLE paths)
    set_property(GLOBAL APPEND PROPERTY CATENA_OPENMM_SOURCES "${paths}")
endfunction()

# catena_compile_together(<target> folders...): with CATENA_UNITY, eight sources of each folder below src/ become one.
function(catena_compile_together target)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ${CATENA_UNITY} UNITY_BUILD_MODE GROUP)
    if(CATENA_UNITY AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        # A class of a source may have members of its unnamed namespace; gcc takes what is included for a header.
        target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-Wno-subobject-linkage>)
    endif()
    get_target_property(sources ${target} SOURCES)
    get_property(openmm GLOBAL PROPERTY CATENA_OPENMM_SOURCES)
    foreach(folder IN LISTS ARGN)
        set(together ${sources})
        list(FILTER together INCLUDE REGEX "/src/${folder}/[^/]*[.]cpp$")
        set(number 0)
        set(of_openmm 0)
        foreach(source IN LISTS together)
            if(source IN_LIST openmm)
                math(EXPR group "${of_openmm} / 8")
                math(EXPR of_openmm "${of_openmm} + 1")
                set(group "openmm_${group}")
            else()
                math(EXPR group "${number} / 8")
                math(EXPR number "${number} + 1")
            endif()
            set_property(SOURCE "${source}" TARGET_DIRECTORY ${target} PROPERTY UNITY_GROUP "${folder}_${group}")
        endforeach()
    endforeach()
endfunction()

# catena_optimise_little(<target>): -O1, for what runs once per run: two thirds of the time to compile.
function(catena_optimise_little target)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# catena_split_off(<target> <part> folders...): moves the target's sources below src/<folder> to the object library <part>.
function(catena_split_off target part)
    list(JOIN ARGN "|" folders)
    get_target_property(sources ${target} SOURCES)
    set(others ${sources})
    list(FILTER sources INCLUDE REGEX "/src/(${folders})/[^/]*$")
    list(FILTER others EXCLUDE REGEX "/src/(${folders})/[^/]*$")
    set_target_properties(${target} PROPERTIES SOURCES "${others}")
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${part}>)
    target_sources(${part} PRIVATE ${sources})
endfunction()

# catena_add_simd_sources(<target> parts...): avx2_<part>.cpp and avx512_<part>.cpp of the folder that calls it, or no_levels.cpp, into `target`.
# A source has one instruction set, and parts keep it short to compile. Sources are optimised in every build, so that nothing of them is left
# over that the linker could give to others.
set(CATENA_HAVE_SIMD FALSE)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$" AND NOT (CATENA_SANITIZE AND CATENA_SANITIZE_QUICKLY))
    set(CATENA_HAVE_SIMD TRUE)
endif()
function(catena_add_simd_sources target)
    if(NOT CATENA_HAVE_SIMD)
        target_sources(${target} PRIVATE no_levels.cpp)
        return()
    endif()
    set(flags -O3)
    if(CATENA_SANITIZE)
        list(APPEND flags -fno-sanitize=all)  # whose checks are calls that stay
    endif()
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        list(APPEND flags -Wno-uninitialized -Wno-maybe-uninitialized)  # false alarms, in gcc's own headers too (GCC bug 105593)
        # Segments and joints are numbers to the compiler, not memory, however many they are: stores set the pace.
        # And what is computed before it is wanted (PRE) waits in memory: 3 % of a chain on revolute joints.
        list(APPEND flags --param=sra-max-scalarization-size-Ospeed=4096 -fno-tree-slp-vectorize -fno-tree-pre)
    endif()
    foreach(level IN ITEMS avx2=x86-64-v3 avx512=x86-64-v4)
        string(REPLACE "=" ";" level ${level})
        list(GET level 0 name)
        list(GET level 1 processor)
        list(TRANSFORM ARGN REPLACE "(.+)" "${name}_\\1.cpp" OUTPUT_VARIABLE sources)
        target_sources(${target} PRIVATE ${sources})
        set_source_files_properties(${sources} TARGET_DIRECTORY ${target} PROPERTIES COMPILE_OPTIONS "${flags};-march=${processor}" SKIP_PRECOMPILE_HEADERS ON)
    endforeach()
endfunction()
