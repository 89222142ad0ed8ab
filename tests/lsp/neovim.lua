-- Asks the server of `LAMPLIGHT` what an author would, and says what came back.
local function say(name, good, found)
  io.stdout:write(name .. ': ' .. (good and 'ok' or vim.inspect(found)) .. '\n')
end

local function finish(words)
  if words then io.stdout:write(words .. '\n') end
  vim.cmd('qall!')
end

vim.bo.filetype = 'wesl'
local client = vim.lsp.start_client({
  name = 'lamplight',
  cmd = { os.getenv('LAMPLIGHT'), 'lsp' },
  root_dir = vim.fn.getcwd(),
})
if not client then return finish('no client') end
vim.lsp.buf_attach_client(0, client)

local function errors()
  return vim.diagnostic.get(0, { severity = vim.diagnostic.severity.ERROR })
end
local arrived = vim.wait(60000, function() return #errors() > 0 end, 50)
say('diagnostics', arrived and errors()[1].lnum == 17, vim.diagnostic.get(0))

-- The place of some words, as the protocol counts.
local function place(words, shift)
  for row, line in ipairs(vim.api.nvim_buf_get_lines(0, 0, -1, false)) do
    local column = line:find(words, 1, true)
    if column then
      return {
        textDocument = vim.lsp.util.make_text_document_params(0),
        position = { line = row - 1, character = column - 1 + (shift or 0) },
      }
    end
  end
end

local function ask(method, parameters)
  local found = vim.lsp.buf_request_sync(0, method, parameters, 60000)
  local answer = found and found[client]
  return answer and answer.result
end

local hover = ask('textDocument/hover', place('lambert(n'))
say('hover', hover and hover.contents.value:find('Error model', 1, true), hover)
local definition = ask('textDocument/definition', place('half(sum)'))
say('definition', definition and definition[1].uri:find('util.wesl', 1, true), definition)
local parameters = place('let up', 4)
parameters.newName = 'above'
local edit = ask('textDocument/rename', parameters)
if edit then vim.lsp.util.apply_workspace_edit(edit, 'utf-16') end
local text = table.concat(vim.api.nvim_buf_get_lines(0, 0, -1, false), '\n')
say('rename', text:find('lambert(n, above)', 1, true) and text:find('let above =', 1, true), text)
local items = ask('textDocument/completion', place('lambert(n', 4)) or {}
local found = false
for _, item in ipairs(items) do found = found or item.label == 'lambert' end
say('completion', found, #items)
finish()
