# Debian packages, by cpack. What they need of the system's libraries is found out from the programs.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME framelet)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "framelet maintainers <maintainers@framelet.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # each package has its own, which would follow it
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS # whatever the umask is
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# The form that Debian wants; of the time that SOURCE_DATE_EPOCH says.
string(TIMESTAMP FRAMELET_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(changelog.in changelog @ONLY)
set(change_log ${CMAKE_CURRENT_BINARY_DIR}/changelog.gz)
add_custom_command(
  OUTPUT ${change_log}
  COMMAND ${GZIP} -9nc changelog > ${change_log}
  DEPENDS ${CMAKE_CURRENT_BINARY_DIR}/changelog
  VERBATIM)
add_custom_target(framelet_change_log ALL DEPENDS ${change_log})

# BUILT_IN: of these libraries code is in the programs, so their licences go with them.
function(framelet_package component name)
  cmake_parse_arguments(PARSE_ARGV 2 package "" "SUMMARY;DESCRIPTION;DEPENDS;RECOMMENDS;SUGGESTS;ARCHITECTURE" "BUILT_IN")
  string(TOUPPER ${component} key)
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${component} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_DESCRIPTION "${package_SUMMARY}\n${package_DESCRIPTION}" PARENT_SCOPE)
  foreach(relation DEPENDS RECOMMENDS SUGGESTS ARCHITECTURE)
    if(package_${relation})
      set(CPACK_DEBIAN_${key}_PACKAGE_${relation} "${package_${relation}}" PARENT_SCOPE)
    endif()
  endforeach()
  set(folder ${CMAKE_INSTALL_DATADIR}/doc/${name})
  install(FILES copyright ${change_log} DESTINATION ${folder} COMPONENT ${component})
  foreach(library IN LISTS package_BUILT_IN)
    install(FILES /usr/share/doc/${library}/copyright RENAME copyright.${library}
      DESTINATION ${folder} COMPONENT ${component} OPTIONAL)
  endforeach()
endfunction()

set(headers libboost-dev libcli11-dev libglm-dev)
set(connection libflatbuffers-dev libspdlog-dev nlohmann-json3-dev)
framelet_package(viewer framelet-viewer
  SUMMARY "remote adaptive renderer: viewers"
  DESCRIPTION "Shows a scene that framelet-server renders on another machine or this one:
framelet-viewer in a window that keeps up with the display however slow the
link is, framelet-client as pictures and figures."
  DEPENDS libgl1 # looked for when a window is opened
  # The former is started for a scene file that is opened, one of the others asks which.
  SUGGESTS "framelet-server, zenity | kdialog"
  BUILT_IN ${headers} ${connection} libimgui-dev)
framelet_package(launcher framelet
  SUMMARY "remote adaptive renderer: view a scene with one command"
  DESCRIPTION "framelet view SCENE opens a window and starts a private server for it. Opens glTF,
OBJ and other model files from the desktop, too."
  DEPENDS "framelet-server (= ${PROJECT_VERSION}), framelet-viewer (= ${PROJECT_VERSION})"
  RECOMMENDS framelet-scenes
  BUILT_IN ${headers})
if(FRAMELET_SERVER)
  framelet_package(server framelet-server
    SUMMARY "remote adaptive renderer: server"
    DESCRIPTION "Ray-traces a scene (glTF 2.0, OBJ and what else Assimp reads) for viewers
elsewhere: where their pictures gain most, and no more than their links carry."
    BUILT_IN ${headers} ${connection})
  framelet_package(scenes framelet-scenes
    SUMMARY "remote adaptive renderer: example scenes"
    DESCRIPTION "Animated scenes to try framelet with, in /usr/share/framelet/scenes."
    ARCHITECTURE all)
endif()
include(CPack)
