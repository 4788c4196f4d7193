# Runs while CPack makes the package, when the files of `cmake --install` are in place: adds documents, the unit of the
# frame service with its configuration, and packs what Debian wants packed.
set(root ${CPACK_TEMPORARY_DIRECTORY})
set(source ${CPACK_LUMULUS_SOURCE})
set(documents ${root}/usr/share/doc/lumulus)

# pack(FILE…): gzip without names and times, so that equal files give equal bytes.
function(pack)
  execute_process(COMMAND gzip --best --no-name --force ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(COPY ${source}/README.md ${source}/NOTICE ${source}/configs/debian/copyright DESTINATION ${documents})
file(GLOB pages ${source}/docs/*.md)
file(COPY ${pages} DESTINATION ${documents}/docs)
file(COPY ${source}/src/python/examples/ ${source}/service/client/python/examples/ ${source}/configs/haproxy.cfg
          ${source}/configs/nginx-tls.conf
     DESTINATION ${documents}/examples PATTERN __pycache__ EXCLUDE)
file(COPY_FILE ${CPACK_LUMULUS_BINARY}/package/changelog ${documents}/changelog.Debian)
file(GLOB manuals ${root}/usr/share/man/man1/*.1)
pack(${documents}/changelog.Debian ${manuals})

# The client of the frame service, in one file.
file(COPY ${source}/service/client/python/lumulus_client.py DESTINATION ${root}/usr/lib/python3/dist-packages)

# The frame service. Its configuration belongs to the administrator.
file(READ ${source}/configs/lumulus.service unit)
string(REPLACE "/usr/local/share/doc/lumulus/service.md" "/usr/share/doc/lumulus/docs/service.md" unit "${unit}")
string(REPLACE "/usr/local/" "/usr/" unit "${unit}")
file(WRITE ${root}/lib/systemd/system/lumulus.service "${unit}")
file(READ ${source}/configs/service.toml configuration)
string(REPLACE "folder = \"scenes\"  " "folder = \"/usr/share/lumulus/scenes\"  " configuration "${configuration}")
file(WRITE ${root}/etc/lumulus/service.toml "${configuration}")
file(MAKE_DIRECTORY ${root}/usr/lib/sysusers.d)
file(COPY_FILE ${source}/configs/debian/lumulus.sysusers ${root}/usr/lib/sysusers.d/lumulus.conf)

# Rights of files and folders do not depend on those of the checkout.
file(GLOB_RECURSE all LIST_DIRECTORIES true ${root}/*)
foreach(path ${all})
  if(IS_DIRECTORY ${path})
    file(CHMOD ${path} PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  elseif(NOT path MATCHES "/usr/bin/")
    file(CHMOD ${path} PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
  endif()
endforeach()
