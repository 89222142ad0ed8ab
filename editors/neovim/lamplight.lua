-- Starts `lamplight lsp` for WESL, WGSL and GLSL. For Neovim 0.7 and later; put this file into
-- `~/.config/nvim/plugin/`.
local endings = {
  wesl = 'wesl', wgsl = 'wgsl', glsl = 'glsl', vert = 'glsl', frag = 'glsl', comp = 'glsl',
}
for ending, language in pairs(endings) do
  vim.api.nvim_create_autocmd({ 'BufRead', 'BufNewFile' }, {
    pattern = '*.' .. ending,
    callback = function() vim.bo.filetype = language end,
  })
end

local languages = { 'wesl', 'wgsl', 'glsl' }
local command = { 'lamplight', 'lsp' }
local markers = { 'wesl.toml', 'lamplight.toml' }

if vim.lsp.config then
  vim.lsp.config('lamplight', { cmd = command, filetypes = languages, root_markers = markers })
  vim.lsp.enable('lamplight')
else
  -- Before Neovim 0.11: one server for all files, which finds their packages itself.
  local client
  vim.api.nvim_create_autocmd('FileType', {
    pattern = languages,
    callback = function(event)
      if not client or vim.lsp.client_is_stopped(client) then
        client = vim.lsp.start_client({
          name = 'lamplight', cmd = command, root_dir = vim.fn.getcwd(),
        })
      end
      if client then vim.lsp.buf_attach_client(event.buf, client) end
    end,
  })
end
