#include "render/gl/programs.h"

#include <initializer_list>
#include <string>

namespace galactic::render::gl {
namespace {

struct Stage {
  GLenum kind;
  std::string source;
};

tl::unexpected<Error> refused(const std::string& what, std::string log) {
  while (!log.empty() && (log.back() == '\0' || log.back() == '\n')) log.pop_back();
  return fail(ErrorCode::kInternal, "render backend gl",
              "the driver refuses a " + what + "; report this with the driver's version: " + log);
}

Result<GLuint> compile(const Stage& stage) {
  const GLuint shader = glCreateShader(stage.kind);
  const char* text = stage.source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled != 0) return shader;
  GLint length = 0;
  glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  glGetShaderInfoLog(shader, length, nullptr, log.data());
  glDeleteShader(shader);
  return refused("shader", std::move(log));
}

/// Puts a linked program into `program`; does nothing after an earlier error.
void link(std::initializer_list<Stage> stages, Program& program, Result<void>& outcome) {
  if (!outcome) return;
  program = Program(glCreateProgram());
  for (const Stage& stage : stages) {
    const Result<GLuint> shader = compile(stage);
    if (!shader) {
      outcome = tl::unexpected<Error>(shader.error());
      return;
    }
    glAttachShader(program.get(), *shader);
    // The program keeps the shader alive.
    glDeleteShader(*shader);
  }
  glLinkProgram(program.get());
  GLint linked = 0;
  glGetProgramiv(program.get(), GL_LINK_STATUS, &linked);
  if (linked != 0) return;
  GLint length = 0;
  glGetProgramiv(program.get(), GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  glGetProgramInfoLog(program.get(), length, nullptr, log.data());
  outcome = refused("program", std::move(log));
}

}  // namespace

Result<Programs> makePrograms(const ShaderVariant& variant) {
  Programs programs;
  Result<void> outcome;
  const auto draw = [&](Program& program, bool masked) {
    const Stage vertex{GL_VERTEX_SHADER, vertexSource(variant)};
    const Stage fragment{GL_FRAGMENT_SHADER, fragmentSource(variant, masked)};
    if (variant.layer_in_vertex) {
      link({vertex, fragment}, program, outcome);
    } else {
      link({vertex, {GL_GEOMETRY_SHADER, geometrySource(variant)}, fragment}, program, outcome);
    }
  };
  draw(programs.opaque, false);
  draw(programs.masked, true);
  link({{GL_COMPUTE_SHADER, testSource()}}, programs.test, outcome);
  link({{GL_COMPUTE_SHADER, scanSource()}}, programs.scan, outcome);
  link({{GL_COMPUTE_SHADER, emitSource()}}, programs.emit, outcome);
  link({{GL_COMPUTE_SHADER, resolveSource(variant)}}, programs.resolve, outcome);
  if (!outcome) return tl::unexpected<Error>(outcome.error());
  return programs;
}

}  // namespace galactic::render::gl
