# What a Debian package has besides files that are installed: fields, copyright, changelogs.

# Packages of one release of Debian are newer than those of the release before.
file(READ /etc/os-release OS_RELEASE)
string(REGEX MATCH "VERSION_ID=\"?([0-9.]+)" MATCHED "${OS_RELEASE}")
set(HGMM_DEBIAN_REVISION "1~deb${CMAKE_MATCH_1}")

# Who builds packages for others names himself, as for all of Debian's tools.
set(HGMM_MAINTAINER "mrpt-hgmm authors <mrpt-hgmm@example.org>")
if(DEFINED ENV{DEBEMAIL})
    set(HGMM_MAINTAINER "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
endif()

# Of SOURCE_DATE_EPOCH, where it is set.
string(TIMESTAMP HGMM_DEBIAN_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
set(DEBIAN_FILES ${PROJECT_BINARY_DIR}/debian)
configure_file(${CMAKE_CURRENT_LIST_DIR}/changelog.in ${DEBIAN_FILES}/changelog.Debian @ONLY)
file(COPY_FILE ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${DEBIAN_FILES}/changelog)
execute_process(COMMAND gzip -9nf changelog.Debian changelog
    WORKING_DIRECTORY ${DEBIAN_FILES} COMMAND_ERROR_IS_FATAL ANY)
set(HGMM_PACKAGING_DIR ${CMAKE_CURRENT_LIST_DIR})

# hgmm_deb(COMPONENT PACKAGE SECTION section SUMMARY text ABOUT line...
#     [DEPENDS package...] [RECOMMENDS package...] [SUGGESTS package...])
function(hgmm_deb COMPONENT PACKAGE)
    cmake_parse_arguments(ARG "" "SECTION;SUMMARY" "ABOUT;DEPENDS;RECOMMENDS;SUGGESTS" ${ARGN})
    set_property(GLOBAL APPEND PROPERTY HGMM_COMPONENTS ${COMPONENT})
    string(TOUPPER ${COMPONENT} UPPER)
    set(CPACK_DEBIAN_${UPPER}_PACKAGE_NAME ${PACKAGE} PARENT_SCOPE)
    set(CPACK_DEBIAN_${UPPER}_PACKAGE_SECTION ${ARG_SECTION} PARENT_SCOPE)
    string(JOIN "\n" ABOUT
        "The map is a hierarchy of Gaussian mixtures. For every point it gives the"
        "probability of being occupied, free or unknown." ${ARG_ABOUT})
    set(CPACK_COMPONENT_${UPPER}_DESCRIPTION "${ARG_SUMMARY}\n${ABOUT}" PARENT_SCOPE)
    foreach(FIELD DEPENDS RECOMMENDS SUGGESTS)
        list(JOIN ARG_${FIELD} ", " NAMES)
        if(NAMES)
            set(CPACK_DEBIAN_${UPPER}_PACKAGE_${FIELD} "${NAMES}" PARENT_SCOPE)
        endif()
    endforeach()
    install(FILES ${HGMM_PACKAGING_DIR}/copyright
        ${DEBIAN_FILES}/changelog.gz ${DEBIAN_FILES}/changelog.Debian.gz
        DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${PACKAGE} COMPONENT ${COMPONENT})
endfunction()

# The same for a shared library, which the loader must know of.
macro(hgmm_library_deb COMPONENT PACKAGE)
    hgmm_deb(${COMPONENT} ${PACKAGE} SECTION libs ${ARGN})
    string(TOUPPER ${COMPONENT} UPPER)
    set(CPACK_DEBIAN_${UPPER}_PACKAGE_CONTROL_EXTRA ${HGMM_PACKAGING_DIR}/triggers)
endmacro()

# The same for the Python package, which serves the one version of Python that it was built for.
# Its scripts compile it when it is installed, and remove what was compiled.
macro(hgmm_python_deb COMPONENT PACKAGE)
    foreach(PART MAJOR MINOR)
        get_directory_property(${PART} DIRECTORY python DEFINITION Python_VERSION_${PART})
    endforeach()
    math(EXPR NEXT "${MINOR} + 1")
    hgmm_deb(${COMPONENT} ${PACKAGE} SECTION python ${ARGN}
        DEPENDS "python3 (>= ${MAJOR}.${MINOR}~)" "python3 (<< ${MAJOR}.${NEXT}~)" python3-numpy
        RECOMMENDS python3-matplotlib)
    install(TARGETS python-core
        DESTINATION lib/python3/dist-packages/hgmm COMPONENT ${COMPONENT})
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/hgmm
        DESTINATION lib/python3/dist-packages COMPONENT ${COMPONENT} PATTERN __pycache__ EXCLUDE)
    string(TOUPPER ${COMPONENT} UPPER)
    set(CPACK_DEBIAN_${UPPER}_PACKAGE_CONTROL_EXTRA
        ${HGMM_PACKAGING_DIR}/postinst ${HGMM_PACKAGING_DIR}/prerm)
endmacro()
