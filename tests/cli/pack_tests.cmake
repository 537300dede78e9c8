# The command line of galactic-pack, as a user meets it.
galactic_test(pack_cli_tests
  SOURCES pack_cli_test.cpp ${PROJECT_SOURCE_DIR}/tests/pack_tool/asset_packs.cpp
  LIBRARIES galactic_pack_verbs)
add_dependencies(pack_cli_tests galactic-pack)
