# Where Debian's slurm-wlm is installed. Its scheduler takes seconds for each step: a minute in all, most of it waiting.
find_program(SLURMCTLD slurmctld PATHS /usr/sbin)
find_program(SLURMD slurmd PATHS /usr/sbin)
find_program(SBATCH sbatch)
if(SLURMCTLD AND SLURMD AND SBATCH)
  add_test(NAME cli.slurm COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/slurm_test.py $<TARGET_FILE:lumulus>
                                  ${CMAKE_SOURCE_DIR})
  set_tests_properties(cli.slurm PROPERTIES TIMEOUT 300)
else()
  message(STATUS "Slurm (Debian's slurm-wlm) is not there: the test cli.slurm is left out")
endif()
